// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <cstddef>

#include "artus/detail/haptics/plunger/plunger.h"
#include "artus/detail/operators/operator_phase.h"

namespace artus {

/// What a barrel still gives when the thumb goes no further and holds its plunger for a while: its
/// pressure runs out through the bore, at once where the liquid is thin, and hardly at all at the
/// end where a liquid is the thicker the slower it runs.
class HeldBarrel {
 public:
  /// `seconds`: of holding. Cost: 20 us.
  HeldBarrel(const PlungerParams& params, double seconds);

  /// m^3, from a pressure of `over` Pa in the barrel above that around the bevel, `around` (gauge).
  [[nodiscard]] ARTUS_REALTIME double gives(double over, double around = 0) const noexcept;

 private:
  static constexpr std::size_t kPoints = 128;
  static constexpr double kMin = 1;    // Pa, the first
  static constexpr double kMax = 1e7;  // Pa, the last
  Syringe syringe_;
  double points_per_octave_;
  std::array<double, kPoints> share_{};  // that runs out, by the logarithm of the pressure
};

/// s for which a plunger is held, in which what a barrel of thin liquid gives has run out to within
/// a hundredth: five times the time constant of bore and barrel, at least 1.5 (assumed) and at most
/// 10, as is taught.
[[nodiscard]] double run_out_time(const PlungerParams& params);

/// What a hand does whose liquid runs beside its target or is pushed back: it lets go for a while
/// and moves the tip a little. assumed: all of it.
struct Redirection {
  static constexpr double kResists = 50e3;  ///< Pa around the bevel that a thumb feels
  static constexpr double kNudge = 0.7e-3;  ///< m that the tip is moved at a time
  static constexpr double kEase = 0.5;      ///< s without the thumb meanwhile
  static constexpr int kMost = 4;           ///< times
};

/// What the thumb does of one dose. It presses until what is out and what the barrel will still
/// give while it is held are what was meant, as a hand stops before the mark, or until nothing has
/// gone in for 6 s (assumed). Then it holds the plunger, which a tense space would push back, until
/// the barrel has run out, and lets go.
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
  double volume_;
  double run_out_;  // s
  HeldBarrel barrel_;
  OperatorPhase hold_;
  double before_ = 0;
  double in_vain_ = 0;  // s
  double held_ = 0;     // s
  bool enough_ = false;
};

}  // namespace artus
