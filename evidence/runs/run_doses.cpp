// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/evidence/runs/run_doses.h"

#include <algorithm>
#include <cmath>

#include "artus/detail/core/units.h"

namespace artus {
namespace {

constexpr double kInTargets = 95;  // %

}  // namespace

SyringeRow make_syringe_row(const HapticSnapshot& tick) {
  SyringeRow row;
  row.plunger = tick.feedback.plunger;
  row.n_sites = tick.n_sites;
  std::copy_n(std::begin(tick.sites), tick.n_sites, row.sites.begin());
  return row;
}

void sum_up_doses(const Simulation& simulation, std::span<const RegionId> targets,
                  ThreeInjections& out) {
  const auto spaces = make_joint_spaces(simulation.joint());
  ARTUS_REQUIRE(spaces.has_value(), "a joint's spaces are checked when it is compiled");
  const Plunger& plunger = simulation.syringe().plunger();
  double everywhere = 0;
  for (std::uint32_t k = 0; k < plunger.states().size(); ++k) {
    const SpaceState& state = plunger.states()[k];
    everywhere += state.volume - state.drawn;
    const bool target = std::any_of(targets.begin(), targets.end(), [&](RegionId region) {
      return spaces->of_region[region] == k;
    });
    const bool cavity = plunger.spaces()[k].law.kind == SpaceKind::cavity;
    out.into_cavity = out.into_cavity || (target && cavity);
    if (state.volume > 0) out.given.push_back({plunger.spaces()[k].name, state.volume, target});
  }
  out.unbalanced = plunger.params().syringe.filled - plunger.state().content - everywhere;
}

void claim_doses(ThreeInjections& run) {
  if (run.syringe.empty()) return;
  double all = 0;
  double there = 0;
  for (const GivenTo& to : run.given) {
    all += to.volume;
    if (to.target) there += to.volume;
  }
  run.claims.push_back(claim_at_most({ClaimKind::input, "the scalars are written to balance"},
                                     "what left the needle is somewhere",
                                     std::abs(run.unbalanced) / kCubicCentimetre, 1e-9, "ml"));
  if (!run.into_cavity) return;
  run.claims.push_back(claim_at_least(ClaimKind::independent,
                                      "of what was given, in the targets' places",
                                      all > 0 ? 100 * there / all : 0, kInTargets, "%"));
}

}  // namespace artus
