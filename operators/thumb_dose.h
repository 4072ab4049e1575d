// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include "artus/haptics/plunger/plunger.h"

namespace artus {

/// m^3 that a barrel still gives when the thumb lets go of its plunger: what its pressure (Pa)
/// holds above that around the bevel. A pressure that overcomes the stopper's friction pushes the
/// stopper back first and gives nothing of that, unless the thumb `holds` it.
[[nodiscard]] ARTUS_REALTIME double after_flow(const Syringe& syringe, double pressure,
                                               double tip_pressure, bool holds = false) noexcept;

/// When the thumb of one dose lets go: when what is out and what the barrel will still give are
/// what was meant, as a hand stops before the mark; or when nothing goes in for 6 s (assumed).
class ThumbDose {
 public:
  /// `volume`: m^3 that are meant; `holds`: the thumb stops by holding the plunger, as in
  /// OperatorPhase::thumb_holds.
  ThumbDose(const Syringe& syringe, double volume, bool holds = false) noexcept
      : syringe_(syringe), volume_(volume), holds_(holds) {}

  /// A new dose, with `given` m^3 out already.
  ARTUS_REALTIME void begin(double given) noexcept {
    before_ = given;
    in_vain_ = 0;
    enough_ = false;
  }

  /// One period of `dt` s with `given` m^3 out in all. `pushes`: the thumb gives, or tries as hard
  /// as it will.
  ARTUS_REALTIME void step(bool pushes, double given, double pressure, double tip_pressure,
                           double flow, double dt) noexcept;

  /// The thumb lets go; stays so until the next begin().
  [[nodiscard]] bool enough() const noexcept { return enough_; }

  static constexpr double kFlows = 5e-9;  ///< m^3/s that is seen; assumed

 private:
  static constexpr double kPatience = 6;  // s; assumed
  Syringe syringe_;
  double volume_;
  bool holds_;
  double before_ = 0;
  double in_vain_ = 0;  // s
  bool enough_ = false;
};

}  // namespace artus
