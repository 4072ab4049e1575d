// SPDX-License-Identifier: AGPL-3.0-or-later
#include <pybind11/stl.h>

#include "artus/detail/operators/trajectory_forces.h"
#include "artus/detail/python/borders.h"

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

py::dict run(const Joint& joint, const std::vector<Pose>& poses, double rate,
             const std::string& device) {
  Result<std::vector<TrajectoryForce>> ticks = [&] {
    const py::gil_scoped_release others_may_run;
    return compute_trajectory_forces(joint.scene, poses, rate, device);
  }();
  return to_arrays(value_by_name(std::move(ticks)));
}

py::dict forces(const Joint& joint, const Numbers& poses, double rate, const std::string& device) {
  return run(joint, poses_of(poses, "poses"), rate, device);
}

py::dict insert(const Joint& joint, const Numbers& entry, const Numbers& target, double speed,
                double rate, const std::string& device) {
  const Vec3 from = point_of(entry, "entry");
  const Vec3 to = point_of(target, "target");
  if (!(speed > 0 && speed < 10))
    throw py::value_error("speed must be positive and below 10 m/s; it is in m/s");
  if (!(rate >= 100 && rate <= 20000)) throw py::value_error("rate must be 100 to 20000 Hz");
  if ((to - from).norm() < 1e-6) throw py::value_error("entry and target are the same point");
  return run(joint, straight_insertion(from, to, speed, rate), rate, device);
}

}  // namespace

void add_forces(py::module_& module) {
  module.def("forces", &forces, py::arg("joint"), py::arg("poses"), py::kw_only(),
             py::arg("rate") = 1000.0, py::arg("device") = "ideal",
             "Lead the needle through poses (n, 4, 4), one a tick of `rate` Hz: a dict of arrays.");
  module.def("insert", &insert, py::arg("joint"), py::arg("entry"), py::arg("target"),
             py::kw_only(), py::arg("speed") = 0.01, py::arg("rate") = 1000.0,
             py::arg("device") = "ideal",
             "A straight insertion from 5 mm above entry to target and back: as forces().");
}

}  // namespace artus::python
