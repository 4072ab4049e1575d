// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/evidence/runs/injection_plan.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <vector>

namespace artus {
namespace {

constexpr double kOnBone = 0.3e-3;       // m that a hand presses the tip onto bone by; assumed
constexpr double kTurn = 4e-3;           // rad between the lines that are tried for a pressed body
constexpr int kTurns = 40;               // to each side
constexpr double kBeforeFloor = 0.3e-3;  // m that the tip stays above a floor; assumed

double middle_of(const LineLayer& layer) {
  return (layer.from + layer.to) / 2;
}

/// m along the line where the tip stops: the bevel's opening in the middle of a layer, not the tip
/// behind which it lies.
double tip_in_middle(const LineLayer& layer, double opening) {
  const double middle = middle_of(layer);
  return std::max(std::min(middle + opening / 2, layer.to - kBeforeFloor), middle);
}

/// The same as near to `wanted` in the layer as has the whole opening in it.
double tip_near(const LineLayer& layer, double opening, double wanted) {
  if (wanted < layer.from || wanted > layer.to) return wanted;
  const double first = layer.from + opening;
  const double last = layer.to - kBeforeFloor;
  return first <= last ? std::clamp(wanted, first, last) : tip_in_middle(layer, opening);
}

SpaceKind kind_of(RegionId region, const JointSpaces& spaces) {
  return spaces.spaces[spaces.of_region[region]].law.kind;
}

/// As in three-injections a bursa on the line is what is meant; none when the target is in a cavity
/// already or there is no bursa.
std::optional<RegionId> bursa_on(const Scene& scene, const Vec3& entry, const Vec3& target,
                                 const JointSpaces& spaces) {
  if (kind_of(scene.region_at(target), spaces) == SpaceKind::cavity) return std::nullopt;
  const Vec3 direction = (target - entry).normalized();
  for (const TissueInterval& s :
       tissue_intervals(scene, {entry, target + kStartOutside * direction})) {
    const Tissue& tissue = scene.joint().tissue_of(s.region);
    if (tissue.haptic.hard) break;
    if (tissue.name == "bursa") return s.region;
  }
  return std::nullopt;
}

/// What lies on the bone that the target is in, or on its cartilage.
RegionId region_on_bone(const Scene& scene, const InjectionSpec& spec) {
  RegionId before = scene.region_at(spec.target);
  for (const TissueInterval& s : tissue_intervals(scene, {spec.entry, spec.target})) {
    if (s.region < kFirstRegion) continue;
    if (is_firm(scene.joint().tissue_of(s.region))) break;
    before = s.region;
  }
  return before;
}

/// m along the line that must be in the layer; none: where there is room.
std::optional<double> point_in(const LinePlan& plan) {
  return plan.by_name ? std::nullopt : std::optional(plan.wanted);
}

bool is_free(const Scene& scene, const Segment& path) {
  const auto met = tissue_intervals(scene, path);
  return std::none_of(met.begin(), met.end(), [&](const TissueInterval& s) {
    return s.region >= kFirstRegion && bars_way(scene.joint().tissue_of(s.region));
  });
}

}  // namespace

bool is_firm(const Tissue& tissue) {
  return tissue.haptic.hard || tissue.name == "cartilage" || tissue.name == "labrum";
}

bool bars_way(const Tissue& tissue) {
  return is_firm(tissue) || tissue.name == "nerve" || tissue.name == "artery" ||
         tissue.name == "vein";
}

Result<LinePlan> plan_line(const Scene& scene, const InjectionSpec& spec) {
  LinePlan plan;
  if (!(spec.volume > 0) || !(spec.rate > 0))
    return fail(ErrorCode::invalid, "volume and rate must be above 0", spec.name);
  if (!(spec.press >= 0)) return fail(ErrorCode::invalid, "the press must be 0 or more", spec.name);
  const Vec3 path = spec.target - spec.entry;
  if (!(path.norm() > 1e-6))
    return fail(ErrorCode::invalid, "entry and target are the same point", spec.name);
  const auto spaces = make_joint_spaces(scene.joint());
  ARTUS_TRY(spaces);
  plan.direction = path.normalized();
  plan.wanted = path.norm();
  const std::optional<RegionId> into =
      spec.into ? spec.into : bursa_on(scene, spec.entry, spec.target, *spaces);
  plan.by_name = into.has_value();
  plan.region = into.value_or(scene.region_at(spec.target));
  if (plan.region < kFirstRegion)
    return fail(ErrorCode::invalid, "the target lies outside of the meshed body", spec.name);
  plan.on_bone = scene.joint().tissue_of(plan.region).haptic.hard;
  if (plan.on_bone) plan.region = region_on_bone(scene, spec);
  const auto layer = find_layer(scene, spec.entry, plan.direction, plan.region, point_in(plan));
  if (!layer)
    return fail(ErrorCode::invalid,
                "the line does not meet '" + scene.joint().regions[plan.region].name + "'",
                spec.name);
  plan.layer = *layer;
  plan.solid = kind_of(plan.region, *spaces) == SpaceKind::solid;
  return plan;
}

LinePlan plan_again(const Scene& now, const Vec3& entry, const Vec3& across, const LinePlan& plan) {
  const auto layer_along = [&](const Vec3& direction) {
    return find_layer(now, entry, direction, plan.region, point_in(plan));
  };
  const double rest = plan.layer.to - plan.layer.from;
  const auto planned = layer_along(plan.direction);
  if (planned && planned->to - planned->from >= rest / 2) return plan;
  std::vector<LinePlan> meet;
  std::vector<double> angles;
  for (int k = -kTurns; k <= kTurns; ++k) {
    LinePlan turned = plan;
    turned.direction = Eigen::AngleAxisd(k * kTurn, across) * plan.direction;
    const auto layer = layer_along(turned.direction);
    if (!layer || !is_free(now, {entry, entry + layer->from * turned.direction})) continue;
    turned.layer = *layer;
    turned.wanted = stop_in(plan, *layer, 0);
    meet.push_back(turned);
    angles.push_back(k * kTurn);
  }
  if (meet.empty()) return plan;
  const double middle =
      std::accumulate(angles.begin(), angles.end(), 0.0) / static_cast<double>(angles.size());
  const auto nearest = std::min_element(angles.begin(), angles.end(), [&](double a, double b) {
    return std::abs(a - middle) < std::abs(b - middle);
  });
  return meet[static_cast<std::size_t>(nearest - angles.begin())];
}

double stop_in(const LinePlan& plan, const LineLayer& now, double opening) {
  if (plan.by_name) return tip_in_middle(now, opening);
  if (plan.on_bone) return now.to + kOnBone;
  const LineLayer& rest = plan.layer;
  const bool inside = plan.wanted >= rest.from && plan.wanted <= rest.to && rest.to > rest.from;
  const double share = inside ? (plan.wanted - rest.from) / (rest.to - rest.from) : 0.5;
  const double beside = inside ? 0 : plan.wanted - middle_of(rest);
  const double wanted = now.from + share * (now.to - now.from) + beside;
  return plan.solid ? wanted : tip_near(now, opening, wanted);
}

}  // namespace artus
