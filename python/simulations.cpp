// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <pybind11/stl.h>

#include "artus/detail/python/borders.h"
#include "artus/echo/transducer_file.h"
#include "artus/simulation/simulation.h"

namespace artus::python {
namespace {

/// What a simulation is made with.
struct Choices {
  std::string device;
  std::string transducer;
  double haptic_rate = 1000;  ///< Hz
  double image_rate = 30;     ///< Hz
  bool rigid = false;
};

SessionParams params_of(const Joint& joint, const Choices& choices) {
  SessionParams params;
  params.device = value_by_name(find_device(choices.device));
  params.transducer = value_by_name(find_transducer(choices.transducer)).transducer;
  params.haptic_rate = choices.haptic_rate;
  params.image_rate = choices.image_rate;
  params.deform = !choices.rigid && gives_way(joint.data());
  if (const auto valid = validate(params); !valid) raise(valid.error());
  return params;
}

py::dict felt_as_dict(const Simulation& simulation, const Felt& felt) {
  const HapticSnapshot& tick = simulation.last();
  py::dict out;
  out["time"] = simulation.time();
  out["force"] = array_of(felt.force);
  out["torque"] = array_of(felt.torque);
  out["probe_force"] = array_of(felt.probe_force);
  out["probe_torque"] = array_of(felt.probe_torque);
  out["thumb_force"] = felt.thumb_force;
  out["depth"] = tick.feedback.depth;
  out["region"] = simulation.joint().regions[tick.feedback.region].name;
  out["given"] = tick.feedback.plunger.given;
  out["status"] = felt.status;
  out["image_due"] = felt.image_due;
  return out;
}

py::dict step(Simulation& simulation, const std::optional<Numbers>& needle,
              const std::optional<Numbers>& probe, double thumb, std::optional<double> plunger) {
  Hands hands;
  if (needle) hands.X_WN = pose_of(*needle, "needle");
  if (probe) hands.X_WP = pose_of(*probe, "probe");
  hands.thumb = thumb;
  hands.plunger = plunger;
  const Felt* felt = nullptr;
  {
    const py::gil_scoped_release others_may_run;
    felt = &simulation.step(hands);
  }
  return felt_as_dict(simulation, *felt);
}

py::array render(Simulation& simulation) {
  const Frame* frame = nullptr;
  {
    const py::gil_scoped_release others_may_run;
    frame = &simulation.render();
  }
  py::array_t<std::uint8_t> image(std::vector<py::ssize_t>{frame->height, frame->width});
  std::copy(frame->image.begin(), frame->image.end(), image.mutable_data());
  return image;
}

}  // namespace

void add_simulations(py::module_& module) {
  py::class_<Simulation>(
      module, "Simulation",
      "Both hands in a body, tick by tick: forces, tissue, liquid and picture. No clock: the same "
      "calls give the same bytes. Poses are (4, 4), metres, in the joint's frame.")
      .def(py::init([](const Joint& joint, const std::string& device, const std::string& transducer,
                       double haptic_rate, double image_rate, bool rigid) {
             return std::make_unique<Simulation>(
                 joint.scene,
                 params_of(joint, {device, transducer, haptic_rate, image_rate, rigid}));
           }),
           py::arg("joint"), py::kw_only(), py::arg("device") = "virtuose_6d_desktop",
           py::arg("transducer") = "linear-6-18", py::arg("haptic_rate") = 1000.0,
           py::arg("image_rate") = 30.0, py::arg("rigid") = false)
      .def(
          "step", &step, py::kw_only(), py::arg("needle") = py::none(),
          py::arg("probe") = py::none(), py::arg("thumb") = 0.0, py::arg("plunger") = py::none(),
          "One tick: what both hands do; a dict of what they feel. `thumb` pushes the plunger (N), "
          "or `plunger` says where it stands (m).")
      .def("render", &render, "The picture of the newest image that was due, (height, width).")
      .def_property_readonly("time", &Simulation::time, "s, of the last tick")
      .def_property_readonly("refusal", &Simulation::refusal,
                             "why the body is rigid though it should give way; empty: it is not");
}

}  // namespace artus::python
