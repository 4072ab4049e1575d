// SPDX-License-Identifier: AGPL-3.0-or-later
#include <cmath>
#include <filesystem>

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "artus/anatomy/compile.h"
#include "artus/detail/core/rigid.h"
#include "artus/detail/python/borders.h"

namespace artus::python {
namespace {

constexpr double kFarthest = 10;  // m; what is farther off was meant in millimetres

Joint load_from(JointSource source) {
  LoadOptions options;
  options.surfaces = source.surfaces;
  options.cache = source.cache;
  options.compile.skip_refused = source.skip_refused;
  const py::gil_scoped_release others_may_run;
  auto joint = load_joint(source.path, options);
  if (!joint) {
    const py::gil_scoped_acquire back;
    raise(joint.error());
  }
  // another process may stand in another folder
  std::error_code none;
  for (std::filesystem::path* path : {&source.path, &source.surfaces, &source.cache})
    if (!path->empty() && std::filesystem::exists(*path, none))
      *path = std::filesystem::absolute(*path, none);
  return {std::make_shared<const Scene>(std::make_shared<const CompiledJoint>(std::move(*joint))),
          std::move(source)};
}

Joint load(const std::filesystem::path& path, const std::filesystem::path& surfaces,
           const std::filesystem::path& cache, bool skip_refused) {
  return load_from({path, surfaces, cache, skip_refused});
}

std::string digest_of(const Joint& joint) {
  return joint.data().source_digest + (joint.scene->tissue() ? "-pressed" : "");
}

py::tuple joint_state(const Joint& joint) {
  if (!joint.source || joint.scene->tissue())
    throw py::type_error("joint '" + joint.data().name +
                         "' was made in memory and cannot be pickled: send what it was made of");
  const JointSource& source = *joint.source;
  return py::make_tuple(source.path, source.surfaces, source.cache, source.skip_refused,
                        digest_of(joint));
}

Joint joint_of_state(const py::tuple& state) {
  if (state.size() != 5) throw py::value_error("this is no pickled joint");
  const auto path = state[0].cast<std::filesystem::path>();
  Joint joint = load(path, state[1].cast<std::filesystem::path>(),
                     state[2].cast<std::filesystem::path>(), state[3].cast<bool>());
  if (digest_of(joint) != state[4].cast<std::string>())
    throw py::value_error("the joint at " + path.string() +
                          " is not the one that was pickled: its file has changed");
  return joint;
}

py::list region_names(const Joint& joint) {
  py::list names;
  for (const Region& region : joint.data().regions) names.append(region.name);
  return names;
}

py::list region_tissues(const Joint& joint) {
  py::list names;
  for (std::size_t i = 0; i < joint.data().regions.size(); ++i)
    names.append(joint.data().tissue_of(static_cast<RegionId>(i)).name);
  return names;
}

py::list injections(const Joint& joint) {
  py::list list;
  for (const PlannedInjection& plan : joint.data().injections)
    list.append(py::make_tuple(array_of(plan.entry), array_of(plan.target)));
  return list;
}

py::dict landmarks(const Joint& joint) {
  py::dict all;
  for (const Landmark& landmark : joint.data().landmarks)
    all[py::str(landmark.name)] = array_of(landmark.position);
  return all;
}

py::list needle_intervals(const Joint& joint, const Numbers& entry, const Numbers& tip) {
  const Segment needle{point_of(entry, "entry"), point_of(tip, "tip")};
  if ((needle.end - needle.start).norm() < 1e-9)
    throw py::value_error("entry and tip are the same point");
  py::list list;
  for (const TissueInterval& interval : tissue_intervals(*joint.scene, needle))
    list.append(
        py::make_tuple(joint.data().regions[interval.region].name, interval.entry, interval.exit));
  return list;
}

}  // namespace

void raise(const Error& error) {
  const std::string text = error.to_string();
  PyObject* kind = PyExc_ValueError;
  if (error.code == ErrorCode::not_found) kind = PyExc_FileNotFoundError;
  if (error.code == ErrorCode::unreadable) kind = PyExc_OSError;
  PyErr_SetString(kind, text.c_str());
  throw py::error_already_set();
}

namespace {

std::string shape_text(const Numbers& array) {
  std::string text = "(";
  for (py::ssize_t i = 0; i < array.ndim(); ++i)
    text += (i == 0 ? "" : ", ") + std::to_string(array.shape(i));
  return text + ")";
}

Pose checked_pose(const double* m, const std::string& what) {
  Pose pose = Pose::Identity();
  for (int i = 0; i < 16; ++i)
    if (!std::isfinite(m[i]))
      throw py::value_error(what + " has a number that is not finite, in row " +
                            std::to_string(i / 4) + ", column " + std::to_string(i % 4));
  for (Eigen::Index i = 0; i < 3; ++i)
    for (Eigen::Index j = 0; j < 4; ++j) pose(i, j) = m[4 * i + j];
  if (m[12] != 0 || m[13] != 0 || m[14] != 0 || m[15] != 1)
    throw py::value_error(what + " must have 0, 0, 0, 1 as its last row");
  if (!is_rigid(pose))
    throw py::value_error(what + " is not rigid: its axes must be orthonormal and right-handed");
  if (pose.translation().norm() > kFarthest)
    throw py::value_error(what + " lies " + std::to_string(pose.translation().norm()) +
                          " m away: poses are in metres, is this one in millimetres?");
  return pose;
}

}  // namespace

Pose pose_of(const Numbers& array, const std::string& what) {
  if (array.ndim() != 2 || array.shape(0) != 4 || array.shape(1) != 4)
    throw py::value_error(what + " must have the shape (4, 4), not " + shape_text(array));
  return checked_pose(array.data(), what);
}

std::vector<Pose> poses_of(const Numbers& array, const std::string& what) {
  if (array.ndim() != 3 || array.shape(1) != 4 || array.shape(2) != 4)
    throw py::value_error(what + " must have the shape (n, 4, 4), not " + shape_text(array));
  std::vector<Pose> poses;
  poses.reserve(static_cast<std::size_t>(array.shape(0)));
  for (py::ssize_t i = 0; i < array.shape(0); ++i)
    poses.push_back(checked_pose(array.data() + 16 * i, what + "[" + std::to_string(i) + "]"));
  return poses;
}

Vec3 point_of(const Numbers& array, const std::string& what) {
  if (array.ndim() != 1 || array.shape(0) != 3)
    throw py::value_error(what + " must have the shape (3,), not " + shape_text(array));
  const Vec3 p(array.at(0), array.at(1), array.at(2));
  if (!p.allFinite()) throw py::value_error(what + " has a number that is not finite");
  if (p.norm() > kFarthest)
    throw py::value_error(what + " lies " + std::to_string(p.norm()) +
                          " m away: points are in metres, is this one in millimetres?");
  return p;
}

py::array array_of(const Pose& pose) {
  py::array_t<double> out(std::vector<py::ssize_t>{4, 4});
  for (Eigen::Index i = 0; i < 4; ++i)
    for (Eigen::Index j = 0; j < 4; ++j) out.mutable_at(i, j) = pose.matrix()(i, j);
  return out;
}

py::array array_of(const Vec3& v) {
  py::array_t<double> out(3);
  for (Eigen::Index i = 0; i < 3; ++i) out.mutable_at(i) = v[i];
  return out;
}

void add_bodies(py::module_& module) {
  py::class_<Joint>(module, "Joint", "A compiled joint; share it between threads and renderers.")
      .def_property_readonly("name", [](const Joint& j) { return j.data().name; })
      .def_property_readonly("regions", &region_names, "Names by region id.")
      .def_property_readonly("tissues", &region_tissues, "Tissue of each region, by region id.")
      .def_property_readonly("digest", &digest_of)
      .def_property_readonly(
          "probe", [](const Joint& j) { return array_of(j.data().X_JP_default); },
          "(4, 4) m: the default pose of the probe.")
      .def_property_readonly(
          "needle", [](const Joint& j) { return array_of(j.data().X_JN_default); },
          "(4, 4) m: the default pose of the needle, origin at the tip.")
      .def_property_readonly("injections", &injections, "[(entry, target)], (3,) m each.")
      .def_property_readonly("landmarks", &landmarks, "{name: (3,) m}.")
      .def("_forget_source", [](Joint& j) { j.source.reset(); })
      .def(py::pickle(&joint_state, &joint_of_state))
      .def("__repr__", [](const Joint& j) {
        return "<artus.Joint '" + j.data().name + "' of " +
               std::to_string(j.data().regions.size()) + " regions>";
      });
  module.def("load", &load, py::arg("path"), py::kw_only(), py::arg("surfaces") = "",
             py::arg("cache") = "", py::arg("skip_refused") = false,
             "Load a compiled joint (.artus), or compile a joint folder and keep it.");
  module.def("needle_intervals", &needle_intervals, py::arg("joint"), py::arg("entry"),
             py::arg("tip"), "[(region, entry, exit)] in m along the line from entry to tip.");
}

}  // namespace artus::python
