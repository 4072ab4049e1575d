// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include "artus/detail/evidence/runs/three_injections.h"
#include "artus/detail/operators/thumb.h"
#include "artus/detail/operators/thumb_dose.h"

namespace artus {

/// The syringe of a run that is not dry: the same as a session's, with a thumb on it that means
/// what the operator's phase says. One body and one syringe through all passes.
class TargetSyringe {
 public:
  /// `doses`: how many the syringe must hold. Errors: those of make_plunger_params.
  [[nodiscard]] static Result<TargetSyringe> make(const CompiledJoint& joint,
                                                  const ThreeInjectionsOptions& options,
                                                  double needle_length, std::size_t doses);

  /// One tick: `phase` of the operator, null: none. Returns N on the needle along its axis.
  double step(const OperatorPhase* phase, const NeedleContact& contact);

  /// What was meant at this target is in, or does not go in.
  [[nodiscard]] bool given() const noexcept;
  [[nodiscard]] SyringeRow row() const;
  [[nodiscard]] const Liquid& liquid() const noexcept { return core_.plunger().params().liquid; }
  /// Places and balance into `out`. A place is a target when one of `targets` is in it.
  void finish(std::span<const RegionId> targets, ThreeInjections& out) const;

 private:
  TargetSyringe(const CompiledJoint& joint, const SessionParams& params, double volume);

  double dt_;  // s
  SyringeCore core_;
  Thumb thumb_;
  ThumbDose dose_;
  std::vector<std::uint32_t> space_of_region_;
  bool pushing_ = false;
};

/// Claims of what was given: the balance, and where a target is a bursa or joint how much came
/// there. None of a dry run.
void claim_doses(ThreeInjections& run);

}  // namespace artus
