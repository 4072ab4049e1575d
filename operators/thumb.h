// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include "artus/detail/haptics/plunger/plunger.h"
#include "artus/detail/operators/operator_phase.h"

namespace artus {

/// A thumb on a plunger. Stiffness and the strongest comfortable push are assumed.
struct ThumbParams {
  double stiffness = 2000;  ///< N/m
  double max_force = 40;    ///< N beyond which it does not press to keep a rate
};

/// Moves a plunger as an operator's phase says: at a rate, by a position that runs ahead of the
/// plunger as far as the force allows, or by a force, or holds it where it is. When it breaks loose
/// the stopper starts with a pulse, as hands do.
class Thumb {
 public:
  explicit Thumb(const ThumbParams& params = {}) noexcept : params_(params) {}

  /// What the thumb does in the next tick of `dt` s; `phase` null: rests. Only force, position and
  /// stiffness are set. `area`: m^2 of the plunger.
  ARTUS_REALTIME PlungerInput step(const OperatorPhase* phase, const PlungerState& plunger,
                                   double area, double dt) noexcept;

  /// It presses to keep a rate, and as hard as it will: what does not flow now will not. Before, at
  /// a slow rate on a wide barrel, the stopper may not even have broken loose.
  [[nodiscard]] bool strains() const noexcept { return strains_; }

 private:
  ThumbParams params_;
  double position_ = 0;  // m, where it wants the plunger
  bool pressing_ = false;
  bool strains_ = false;
};

}  // namespace artus
