// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include "artus/core/result.h"
#include "artus/detail/anatomy/body/space.h"
#include "artus/detail/evidence/runs/injection_run.h"
#include "artus/raycast/scene.h"

namespace artus {

/// Whether liquid does not part it: bone, cartilage, labrum.
[[nodiscard]] bool is_firm(const Tissue& tissue);

/// Whether no needle goes through it on its way: bone and its cartilage, nerves and vessels.
[[nodiscard]] bool bars_way(const Tissue& tissue);

/// What lies on the line of an injection.
struct LinePlan {
  Vec3 direction = Vec3::UnitZ();
  RegionId region = kOutside;  ///< to inject
  bool by_name = false;        ///< or the target's own
  bool on_bone = false;        ///< or what lies on the bone, or its cartilage, of the target
  LineLayer layer;             ///< of it, at rest
  double wanted = 0;           ///< m along the line, the target
  bool solid = false;          ///< nothing goes in: the target as it is
};

/// Where a spec's line goes. As in three-injections a bursa on it is what is meant, unless the
/// target is in a cavity already; where the target is in bone, what lies on that. Errors: invalid
/// (volume or rate not above 0, a press below 0, entry and target the same point, a target outside
/// of the meshed body, a line that does not meet the structure).
[[nodiscard]] Result<LinePlan> plan_line(const Scene& scene, const InjectionSpec& spec);

/// The plan in a body that gave way, `now`: where a press has moved what was meant off the line,
/// the middle one of the lines through the same point, turned about `across`, that meet it with
/// nothing before that bars the way. The plan itself where its line still has half as much of it,
/// or none meets it. Cost: some hundred lines through the scene.
[[nodiscard]] LinePlan plan_again(const Scene& now, const Vec3& entry, const Vec3& across,
                                  const LinePlan& plan);

/// m along the line where the tip stops, the bevel's opening (m) in the layer as it is now: by
/// `now`, the plan's own at rest.
[[nodiscard]] double stop_in(const LinePlan& plan, const LineLayer& now, double opening);

}  // namespace artus
