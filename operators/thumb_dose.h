// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include "artus/haptics/plunger/plunger.h"
#include "artus/operators/operator_phase.h"

namespace artus {

/// m^3 that a barrel still gives when the thumb goes no further and holds its plunger: what its
/// pressure (Pa) holds above that around the bevel.
[[nodiscard]] ARTUS_REALTIME double after_flow(const Syringe& syringe, double pressure,
                                               double tip_pressure) noexcept;

/// s in which what a held barrel gives has run out through the needle to within a hundredth: five
/// times the time constant of bore and barrel, at least 1.5 (assumed) and at most 10, as is taught.
[[nodiscard]] double run_out_time(const PlungerParams& params);

/// What the thumb does of one dose. It presses until what is out and what the barrel will still
/// give are what was meant, as a hand stops before the mark, or until nothing has gone in for 6 s
/// (assumed). Then it holds the plunger, which a tense space would push back, until the barrel has
/// run out, and lets go.
class ThumbDose {
 public:
  /// `volume`: m^3 that are meant.
  ThumbDose(const PlungerParams& params, double volume);

  /// A new dose, with `given` m^3 out already.
  ARTUS_REALTIME void begin(double given) noexcept {
    before_ = given;
    in_vain_ = 0;
    held_ = 0;
    enough_ = false;
  }

  /// One period of `dt` s with `given` m^3 out in all. `pushes`: the thumb gives, or tries as hard
  /// as it will.
  ARTUS_REALTIME void step(bool pushes, double given, double pressure, double tip_pressure,
                           double flow, double dt) noexcept;

  /// It presses no further; stays so until the next begin().
  [[nodiscard]] bool enough() const noexcept { return enough_; }
  /// It has let go; stays so until the next begin().
  [[nodiscard]] bool done() const noexcept { return enough_ && held_ >= run_out_; }
  /// What the thumb does now, where `push` is how it presses; null: nothing.
  [[nodiscard]] const OperatorPhase* present(const OperatorPhase* push) const noexcept {
    if (!enough_) return push;
    return done() ? nullptr : &hold_;
  }

  static constexpr double kFlows = 5e-9;  ///< m^3/s that is seen; assumed

 private:
  static constexpr double kPatience = 6;  // s; assumed
  Syringe syringe_;
  double volume_;
  double run_out_;  // s
  OperatorPhase hold_;
  double before_ = 0;
  double in_vain_ = 0;  // s
  double held_ = 0;     // s
  bool enough_ = false;
};

}  // namespace artus
