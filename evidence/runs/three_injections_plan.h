// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <span>
#include <vector>

#include "artus/detail/evidence/runs/three_injections.h"
#include "artus/detail/operators/operator_phase.h"
#include "artus/raycast/scene.h"

namespace artus {

constexpr double kOutsideAtFirst = 0.012;  ///< m before the skin, where each injection begins

/// One injection as planned: the line and what the operator does.
struct InjectionPass {
  Vec3 entry = Vec3::Zero();
  Vec3 direction = Vec3::UnitZ();
  std::vector<OperatorPhase> phases;
  double deepest = 0;  ///< m, bone or target
  RegionId target = kOutside;
};

/// What the operator of the medical test means to do on this body at rest. Errors: invalid, as
/// run_three_injections has them.
[[nodiscard]] Result<std::array<InjectionPass, 3>> plan_passes(
    const Scene& scene, std::span<const PlannedInjection> injections,
    const ThreeInjectionsOptions& options);

/// m, the shortest needle there is that reaches what is planned.
[[nodiscard]] double choose_needle(const std::array<InjectionPass, 3>& passes);

/// Where the probe belongs at each of what is planned and named, in their order: on the skin, in
/// the plane of its line.
[[nodiscard]] std::vector<Pose> plan_seats(const Scene& scene,
                                           const std::array<InjectionPass, 3>& passes);

/// How many doses are given in all.
[[nodiscard]] std::size_t count_doses(const std::array<InjectionPass, 3>& passes);

}  // namespace artus
