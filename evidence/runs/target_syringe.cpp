// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/evidence/runs/target_syringe.h"

#include <algorithm>
#include <cmath>

#include "artus/detail/core/units.h"

namespace artus {
namespace {

constexpr double kOverDrawn = 0.4e-6;  // m^3 drawn up beyond the doses; assumed
constexpr double kInTargets = 95;      // %

}  // namespace

TargetSyringe::TargetSyringe(const CompiledJoint& joint, const SessionParams& params, double volume)
    : dt_(1 / params.haptic_rate),
      core_(joint, params),
      thumb_({SyringeCore::kCoupling, SyringeCore::kMaxForce}),
      dose_(core_.plunger().params(), volume) {
  const auto spaces = make_joint_spaces(joint);
  ARTUS_REQUIRE(spaces.has_value(), "the joint's spaces must be valid");
  space_of_region_ = spaces->of_region;
}

Result<TargetSyringe> TargetSyringe::make(const CompiledJoint& joint,
                                          const ThreeInjectionsOptions& options,
                                          double needle_length, std::size_t doses) {
  SessionParams params;
  params.haptic_rate = options.rate_hz;
  params.feel = options.feel;
  params.feel.needle_length = needle_length;
  params.syringe = options.dose.syringe;
  params.syringe.filled = options.dose.volume * static_cast<double>(doses) + kOverDrawn;
  params.syringe.seed = options.seed;
  const auto plunger = make_plunger_params(params.syringe, needle_length);
  ARTUS_TRY(plunger);
  return TargetSyringe(joint, params, options.dose.volume);
}

double TargetSyringe::step(const OperatorPhase* phase, const NeedleContact& contact) {
  const bool meant = phase != nullptr && phase->until_given;
  if (meant && !pushing_) dose_.begin(core_.feedback().given);
  pushing_ = meant;
  const Plunger& plunger = core_.plunger();
  const PlungerInput request = thumb_.step(meant ? dose_.present(phase) : nullptr, plunger.state(),
                                           plunger.params().syringe.area(), dt_);
  DeviceSample sample;
  sample.plunger = request.stiffness > 0 ? PlungerSign::travel : PlungerSign::force;
  sample.plunger_travel = request.position;
  sample.plunger_force = request.force;
  core_.step(sample, contact);
  const PlungerFeedback& now = core_.feedback();
  const bool pushes = meant && (now.flow > ThumbDose::kFlows || thumb_.strains());
  dose_.step(pushes, now.given, now.pressure, now.tip_pressure, now.flow, dt_);
  return core_.on_needle();
}

bool TargetSyringe::given() const noexcept {
  return dose_.done();
}

SyringeRow TargetSyringe::row() const {
  SyringeRow row;
  row.plunger = core_.feedback();
  const auto sites = core_.sites();
  row.n_sites = static_cast<std::uint32_t>(sites.size());
  std::copy(sites.begin(), sites.end(), row.sites.begin());
  return row;
}

void TargetSyringe::finish(std::span<const RegionId> targets, ThreeInjections& out) const {
  const Plunger& plunger = core_.plunger();
  double everywhere = 0;
  for (std::uint32_t k = 0; k < plunger.states().size(); ++k) {
    const SpaceState& state = plunger.states()[k];
    everywhere += state.volume - state.drawn;
    const bool target = std::any_of(targets.begin(), targets.end(),
                                    [&](RegionId region) { return space_of_region_[region] == k; });
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
