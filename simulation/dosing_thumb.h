// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include "artus/detail/operators/thumb.h"
#include "artus/detail/operators/thumb_dose.h"
#include "artus/simulation/input_device.h"

namespace artus {

/// A simulated thumb on a device's plunger: it does what an operator's phase means, by what it felt
/// in the tick before. In a phase `until_given` it gives a dose as ThumbDose says; in all others it
/// presses, pulls or holds for as long as the phase lasts.
class DosingThumb {
 public:
  /// `volume`: m^3 of a dose. `rate_hz`: ticks a second.
  DosingThumb(const PlungerParams& params, double volume, double rate_hz);

  /// A new dose from here on; without it all that is given counts for one.
  ARTUS_REALTIME void begin() noexcept { dose_.begin(felt_.given); }
  /// What the device says of the plunger in the next tick; `phase` null: the thumb rests.
  ARTUS_REALTIME void press(const OperatorPhase* phase, DeviceSample& sample) noexcept;
  /// What came of it.
  ARTUS_REALTIME void feel(const PlungerFeedback& felt) noexcept;

  /// Of the dose: it presses no further; it has let go.
  [[nodiscard]] bool enough() const noexcept { return dose_.enough(); }
  [[nodiscard]] bool done() const noexcept { return dose_.done(); }

 private:
  double area_;    // m^2
  double period_;  // s
  Thumb thumb_;
  ThumbDose dose_;
  bool doses_ = false;  // in this tick
  PlungerFeedback felt_;
};

}  // namespace artus
