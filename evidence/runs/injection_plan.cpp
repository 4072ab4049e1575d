// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/evidence/runs/injection_plan.h"

#include <algorithm>
#include <optional>

namespace artus {
namespace {

constexpr double kBeforeFloor = 0.3e-3;  // m that the tip stays above a floor; assumed

/// m along the line where the tip stops: the bevel's opening in the middle of a layer, not the tip
/// behind which it lies.
double tip_in_middle(const LineLayer& layer, double opening) {
  const double middle = (layer.from + layer.to) / 2;
  return std::max(std::min(middle + opening / 2, layer.to - kBeforeFloor), middle);
}

/// The same as near to `wanted` in the layer as has the whole opening in it.
double tip_near(const LineLayer& layer, double opening, double wanted) {
  if (wanted < layer.from || wanted > layer.to) return wanted;
  const double first = layer.from + opening;
  const double last = layer.to - kBeforeFloor;
  return first <= last ? std::clamp(wanted, first, last) : tip_in_middle(layer, opening);
}

/// As in three-injections a bursa on the line is what is meant; none when the target is in a cavity
/// already or there is no bursa.
std::optional<RegionId> bursa_on(const Scene& scene, const Vec3& entry, const Vec3& target) {
  const auto spaces = make_joint_spaces(scene.joint());
  if (!spaces) return std::nullopt;
  const auto law = [&](RegionId r) {
    return spaces->spaces[spaces->of_region[r]].law.kind;
  };
  if (law(scene.region_at(target)) == SpaceKind::cavity) return std::nullopt;
  const Vec3 direction = (target - entry).normalized();
  for (const TissueInterval& s :
       tissue_intervals(scene, {entry, target + kStartOutside * direction})) {
    const Tissue& tissue = scene.joint().tissue_of(s.region);
    if (tissue.haptic.hard) break;
    if (tissue.name == "bursa") return s.region;
  }
  return std::nullopt;
}

}  // namespace

Result<LinePlan> plan_line(const Scene& scene, const InjectionSpec& spec) {
  LinePlan plan;
  if (!(spec.volume > 0) || !(spec.rate > 0))
    return fail(ErrorCode::invalid, "volume and rate must be above 0", spec.name);
  if (!(spec.press >= 0)) return fail(ErrorCode::invalid, "the press must be 0 or more", spec.name);
  const Vec3 path = spec.target - spec.entry;
  if (!(path.norm() > 1e-6))
    return fail(ErrorCode::invalid, "entry and target are the same point", spec.name);
  plan.direction = path.normalized();
  const std::optional<RegionId> into =
      spec.into ? spec.into : bursa_on(scene, spec.entry, spec.target);
  plan.by_name = into.has_value();
  plan.region = into.value_or(scene.region_at(spec.target));
  if (plan.region < kFirstRegion)
    return fail(ErrorCode::invalid, "the target lies outside of the meshed body", spec.name);
  const auto layer = find_layer(scene, spec.entry, plan.direction, plan.region);
  if (!layer)
    return fail(ErrorCode::invalid,
                "the line does not meet '" + scene.joint().regions[plan.region].name + "'",
                spec.name);
  plan.layer = *layer;
  return plan;
}

double stop_on(const LinePlan& plan, const InjectionSpec& spec, const JointSpaces& spaces,
               double opening) {
  const double wanted = (spec.target - spec.entry).norm();
  if (plan.by_name) return tip_in_middle(plan.layer, opening);
  const bool solid = spaces.spaces[spaces.of_region[plan.region]].law.kind == SpaceKind::solid;
  return solid ? wanted : tip_near(plan.layer, opening, wanted);
}

}  // namespace artus
