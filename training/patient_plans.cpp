// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/training/patient_plans.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "artus/detail/anatomy/body/skin_line.h"

namespace artus {
namespace {

constexpr double kBeyondTarget = 8e-3;  // m past the point aimed at, where the target may begin

bool is_region(const Scene& scene, RegionId region, const std::string& name) {
  return scene.joint().regions[region].name == name;
}

/// The middle of the target's stretch of the needle's path that is nearest to the point aimed at.
std::optional<Vec3> middle_of_target(const Scenario& s, const Scene& scene) {
  const Vec3 path = (s.target.point - s.entry.centre).normalized();
  const double aimed = (s.target.point - s.entry.centre).norm();
  std::optional<double> nearest;
  for (const TissueInterval& layer :
       tissue_intervals(scene, {s.entry.centre, s.entry.centre + (aimed + kBeyondTarget) * path})) {
    if (!is_region(scene, layer.region, s.target.structure)) continue;
    const double middle = (layer.entry + layer.exit) / 2;
    if (!nearest || std::abs(middle - aimed) < std::abs(*nearest - aimed)) nearest = middle;
  }
  if (!nearest) return std::nullopt;
  return s.entry.centre + *nearest * path;
}

}  // namespace

Result<Scenario> of_patient(const Scenario& scenario, const std::string& patient) {
  if (scenario.joint.empty())
    return fail(ErrorCode::invalid, "the scenario has no joint, so no patient can be chosen",
                scenario.name);
  std::string text;
  bool in_head = true;
  for (std::size_t begin = 0; begin < scenario.text.size();) {
    const std::size_t end = std::min(scenario.text.find('\n', begin), scenario.text.size() - 1) + 1;
    const std::string line = scenario.text.substr(begin, end - begin);
    begin = end;
    if (line.rfind('[', 0) == 0) in_head = false;
    if (!in_head || line.rfind("patient", 0) != 0) text += line;
  }
  return parse_scenario("patient = '" + patient + "'\n" + text, scenario.name);
}

void follow_patient(Scenario& scenario, const Scene& scene) {
  if (scenario.patient.empty()) return;
  const CompiledJoint& joint = scene.joint();
  Pose& X_JP = scenario.X_JP;
  X_JP.translation() = moved_onto_skin(joint, X_JP.translation(), X_JP.linear().col(2));
  ScenarioEntry& entry = scenario.entry;
  const Vec3 path = (scenario.target.point - entry.centre).normalized();
  entry.centre = moved_onto_skin(joint, entry.centre, path);
  const std::string& structure = scenario.target.structure;
  if (structure.empty() || is_region(scene, scene.region_at(scenario.target.point), structure))
    return;
  if (const auto middle = middle_of_target(scenario, scene)) scenario.target.point = *middle;
}

}  // namespace artus
