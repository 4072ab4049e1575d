// SPDX-License-Identifier: AGPL-3.0-or-later
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <pybind11/stl.h>

#include "artus/detail/python/borders.h"
#include "artus/detail/simulation/trajectory_forces.h"

namespace artus::python {
namespace {

py::dict to_arrays(const std::vector<TrajectoryForce>& ticks) {
  const auto n = static_cast<py::ssize_t>(ticks.size());
  py::array_t<double> force(std::vector<py::ssize_t>{n, 3});
  py::array_t<double> torque(std::vector<py::ssize_t>{n, 3});
  py::array_t<double> axial(n);
  py::array_t<double> depth(n);
  py::array_t<std::uint16_t> region(n);
  py::array_t<std::uint16_t> contact(n);
  py::array_t<std::uint32_t> status(n);
  for (py::ssize_t i = 0; i < n; ++i) {
    const TrajectoryForce& tick = ticks[static_cast<std::size_t>(i)];
    for (Eigen::Index j = 0; j < 3; ++j) {
      force.mutable_at(i, j) = tick.force[j];
      torque.mutable_at(i, j) = tick.torque[j];
    }
    axial.mutable_at(i) = tick.axial;
    depth.mutable_at(i) = tick.depth;
    region.mutable_at(i) = tick.region;
    contact.mutable_at(i) = tick.contact;
    status.mutable_at(i) = tick.status;
  }
  py::dict out;
  out["force"] = force;
  out["torque"] = torque;
  out["axial"] = axial;
  out["depth"] = depth;
  out["region"] = region;
  out["contact"] = contact;
  out["status"] = status;
  return out;
}

/// How a trajectory is felt.
struct Feeling {
  double rate = 1000;  ///< Hz
  std::string device;
  bool rigid = false;
};

py::dict run(const Joint& joint, const std::vector<TrajectoryPose>& poses, const Feeling& how) {
  Result<std::vector<TrajectoryForce>> ticks = [&]() -> Result<std::vector<TrajectoryForce>> {
    const py::gil_scoped_release others_may_run;
    const auto params = trajectory_params(*joint.scene, how.device, how.rate, how.rigid);
    ARTUS_TRY(params);
    return compute_trajectory_forces(joint.scene, poses, *params);
  }();
  return to_arrays(value_by_name(std::move(ticks)));
}

py::dict forces(const Joint& joint, const Numbers& needles, const std::optional<Numbers>& probes,
                double rate, const std::string& device, bool rigid) {
  std::vector<TrajectoryPose> poses;
  for (const Pose& X_JN : poses_of(needles, "poses")) poses.push_back({X_JN, {}});
  if (probes) {
    const std::vector<Pose> at = poses_of(*probes, "probe");
    if (at.size() != poses.size() && at.size() != 1)
      throw py::value_error("probe needs one pose, or as many as the needle");
    for (std::size_t i = 0; i < poses.size(); ++i) poses[i].X_JP = at[at.size() == 1 ? 0 : i];
  }
  return run(joint, poses, {rate, device, rigid});
}

py::dict insert(const Joint& joint, const std::pair<Numbers, Numbers>& line, double speed,
                const Feeling& how) {
  const auto& [entry, target] = line;
  const double rate = how.rate;
  const Vec3 from = point_of(entry, "entry");
  const Vec3 to = point_of(target, "target");
  if (!(speed > 0 && speed < 10))
    throw py::value_error("speed must be positive and below 10 m/s; it is in m/s");
  if (!(rate >= 100 && rate <= 20000)) throw py::value_error("rate must be 100 to 20000 Hz");
  if ((to - from).norm() < 1e-6) throw py::value_error("entry and target are the same point");
  std::vector<TrajectoryPose> poses;
  for (const Pose& X_JN : straight_insertion(from, to, speed, rate)) poses.push_back({X_JN, {}});
  return run(joint, poses, how);
}

}  // namespace

void add_forces(py::module_& module) {
  module.def("forces", &forces, py::arg("joint"), py::arg("poses"), py::arg("probe") = py::none(),
             py::kw_only(), py::arg("rate") = 1000.0, py::arg("device") = "ideal",
             py::arg("rigid") = false,
             "Lead the needle through poses (n, 4, 4), one a tick of `rate` Hz, and a probe, one "
             "pose or as many: a dict of arrays. Tissue gives way unless `rigid`.");
  module.def(
      "insert",
      [](const Joint& joint, const Numbers& entry, const Numbers& target, double speed, double rate,
         const std::string& device, bool rigid) {
        return insert(joint, {entry, target}, speed, {rate, device, rigid});
      },
      py::arg("joint"), py::arg("entry"), py::arg("target"), py::kw_only(), py::arg("speed") = 0.01,
      py::arg("rate") = 1000.0, py::arg("device") = "ideal", py::arg("rigid") = false,
      "A straight insertion from 5 mm above entry to target and back: as forces().");
}

}  // namespace artus::python
