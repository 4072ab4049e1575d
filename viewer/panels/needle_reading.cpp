// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/viewer/panels/needle_reading.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "artus/detail/core/units.h"
#include "artus/detail/session/liquid_at_tip.h"
#include "artus/detail/soft/solver/deformed_body.h"
#include "artus/detail/viewer/words/anatomy_names.h"

namespace artus {
namespace {

constexpr double kInPlaneOffset = 1.5e-3;      // m; assumed: half the slice's thickness
constexpr double kInPlaneAngle = 5 * kDegree;  // assumed: beyond it a dot of the shaft shows
constexpr double kAhead = 12e-3;               // m beyond the tip, for the neighbour's name
constexpr double kHubSlack = 0.3e-3;           // m

/// The stretch in which depth `at` lies.
std::size_t stretch_at(const std::vector<TissueInterval>& line, double at) {
  std::size_t k = 0;
  while (k + 1 < line.size() && line[k].exit <= at) ++k;
  return k;
}

}  // namespace

NeedleReading read_needle(const Scene& scene, const HapticSnapshot& now, double needle_length,
                          const std::optional<Vec3>& target_J, Language language) {
  NeedleReading reading;
  const Pose X_JN = to_pose(now.X_JN);
  const Vec3 axis = X_JN.linear().col(2);
  const CompiledJoint& joint = scene.joint();
  reading.inside = now.inserted != 0;
  reading.depth = now.feedback.depth;
  reading.region =
      static_cast<RegionId>(std::min<std::size_t>(now.feedback.region, joint.regions.size() - 1));
  reading.layer = clinical_name(language, joint.regions[reading.region].name);
  if (reading.inside && reading.depth > 0) {
    const Vec3 before = X_JN.translation() - (reading.depth + 1e-3) * axis;
    const auto line = tissue_intervals(scene, {before, X_JN.translation() + kAhead * axis});
    std::size_t k = stretch_at(line, reading.depth + 1e-3);
    for (std::size_t i = 0; i <= k; ++i) {
      if (!joint.tissue_of(line[i].region).haptic.hard) continue;
      reading.on_bone = true;
      reading.hand_excess = reading.depth + 1e-3 - line[i].entry;
      k = i;
      break;
    }
    reading.depth -= reading.hand_excess;
    if (line[k].region == reading.region || reading.on_bone) {
      reading.region = line[k].region;
      reading.layer = layer_name(language, joint, line, k);
    }
  }
  if (const auto liquid = liquid_at_tip(now); liquid && *liquid < joint.regions.size())
    reading.layer = fill(translate(language, "liquid in: {}"),
                         {clinical_name(language, joint.regions[*liquid].name)});
  reading.hub_on_skin = reading.inside && reading.depth >= needle_length - kHubSlack;
  const Vec3 tip = X_JN.translation() - reading.hand_excess * axis;
  if (target_J) {
    const Vec3 carried = scene.tissue() ? scene.tissue()->displacement(*target_J) : Vec3::Zero();
    reading.to_target = (*target_J + carried - tip).norm();
  }
  const Pose X_PJ = to_pose(now.X_JP).inverse();
  reading.plane_offset = (X_PJ * tip).y();
  reading.plane_angle = std::asin(std::clamp(std::abs((X_PJ.linear() * axis).y()), 0.0, 1.0));
  reading.in_plane =
      std::abs(reading.plane_offset) <= kInPlaneOffset && reading.plane_angle <= kInPlaneAngle;
  return reading;
}

Pose needle_pose(const HapticSnapshot& now, const NeedleReading& reading) {
  Pose X_JN = to_pose(now.X_JN);
  X_JN.translation() -= reading.hand_excess * X_JN.linear().col(2);
  return X_JN;
}

std::vector<PictureLabel> find_picture_labels(const Scene& scene, const Pose& X_JP, double width,
                                              double depth, Language language) {
  constexpr int kColumns = 31;
  constexpr double kThin = 0.8e-3;  // m; what is thinner has no room for a name
  struct Best {
    double worth = 0;
    double thickness = 0;  // m
    PictureLabel label;
  };
  std::map<RegionId, Best> best;
  for (int i = 0; i < kColumns; ++i) {
    const double x = width * ((i + 0.5) / kColumns - 0.5);
    const auto line = tissue_intervals(scene, {X_JP * Vec3(x, 0, 0), X_JP * Vec3(x, 0, depth)});
    for (std::size_t k = 0; k < line.size(); ++k) {
      const TissueInterval& s = line[k];
      const double thickness = s.exit - s.entry;
      if (s.region < kFirstRegion || thickness < kThin) continue;
      Best& b = best[s.region];
      // The middle of the picture is where a name is looked for.
      const double worth = thickness * (1 - 0.8 * std::abs(x) / width);
      if (worth <= b.worth) continue;
      b.worth = worth;
      b.thickness = thickness;
      b.label = {layer_name(language, scene.joint(), line, k), s.region,
                 (x + width / 2) / kMillimetre, (s.entry + s.exit) / 2 / kMillimetre};
    }
  }
  std::vector<Best> found;
  for (const auto& [region, b] : best) found.push_back(b);
  std::stable_sort(found.begin(), found.end(),
                   [](const Best& a, const Best& b) { return a.thickness < b.thickness; });
  std::vector<PictureLabel> labels;
  for (const Best& b : found) labels.push_back(b.label);
  return labels;
}

}  // namespace artus
