// SPDX-License-Identifier: AGPL-3.0-or-later
#include <optional>
#include <string>
#include <utility>

#include <pybind11/stl.h>

#include "artus/detail/echo/probe/pressing_face.h"
#include "artus/detail/python/borders.h"
#include "artus/detail/raycast/pressed_scene.h"
#include "artus/echo/transducer_file.h"

namespace artus::python {
namespace {

py::dict press(const Joint& joint, const std::optional<Numbers>& probe, std::optional<double> depth,
               std::optional<double> force, const std::string& transducer) {
  constexpr double kDeepest = 25e-3;  // m
  constexpr double kStrongest = 30;   // N
  if (depth.has_value() == force.has_value())
    throw py::value_error("give either depth (m) or force (N)");
  if (depth && !(*depth >= 0 && *depth <= kDeepest))
    throw py::value_error("depth must be 0 to 0.025 m; it is in metres");
  if (force && !(*force > 0 && *force <= kStrongest))
    throw py::value_error("force must be above 0 and at most 30 N");
  const Pose X_JP = probe ? pose_of(*probe, "probe") : joint.data().X_JP_default;
  if (joint.data().mesh.tetrahedra.empty())
    throw py::value_error("a joint without tetrahedra cannot be pressed");
  if (joint.scene->tissue())
    throw py::value_error("the joint is pressed already: press the one at rest");
  const ProbeFace face = value_of(pressing_face(value_of(find_transducer(transducer)).transducer));
  const PressedScene pressed = value_of([&] {
    const py::gil_scoped_release others_may_run;
    return press_scene(joint.scene->shared_joint(), X_JP, {depth, force}, face);
  }());
  const Press& how = pressed.press;
  py::dict out;
  out["joint"] = Joint{pressed.scene};
  out["probe"] = array_of(how.X_JP);
  out["depth"] = how.depth;
  out["force"] = how.normal_force;
  out["force_J"] = array_of(how.contact.force);
  out["torque_J"] = array_of(how.contact.torque);
  out["contact_share"] = how.contact.share;
  out["short_of"] = how.short_of;
  out["settled"] = how.settled;
  return out;
}

}  // namespace

void add_presses(py::module_& module) {
  module.def(
      "press", &press, py::arg("joint"), py::arg("probe") = py::none(), py::kw_only(),
      py::arg("depth") = py::none(), py::arg("force") = py::none(),
      py::arg("transducer") = "linear-6-18",
      "Press a probe from (4, 4) m on the skin by `depth` m or with `force` N: a dict of the "
      "joint as it then lies, the probe's pose there, and the force on the hand. A face presses "
      "with 40 N at most: `short_of` says how much deeper it was to go, m. `transducer` "
      "says how long the face is; a curved one raises.");
}

}  // namespace artus::python
