// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <optional>
#include <utility>

#include "artus/detail/operators/hand_loop.h"
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

/// Simulated hands as a device, in closed loop with what the simulation gives them:
///
///   const HapticSnapshot& out = simulation.step(simulation.next_input(hands.read(phase)));
///   hands.feel(out.feedback);
///   hands.move(person);
///
/// Who the person is and what it sees of a tick, before it moves on, is the caller's. Frame W.
class SimulatedHands {
 public:
  /// The needle on its device; none before, and after put_down().
  void take_up(HandLoop needle) { needle_ = std::move(needle); }
  void put_down() noexcept { needle_.reset(); }
  /// None: what the device says of its plunger is nothing.
  void set_thumb(DosingThumb thumb) { thumb_ = std::move(thumb); }
  /// Where the probe is from the next tick on; none: lifted off.
  ARTUS_REALTIME void hold_probe(const std::optional<Pose>& X_WP) noexcept;

  /// Requires: a needle; a thumb.
  [[nodiscard]] const HandLoop& needle() const noexcept { return *needle_; }
  [[nodiscard]] DosingThumb& thumb() noexcept { return *thumb_; }
  [[nodiscard]] const DosingThumb& thumb() const noexcept { return *thumb_; }
  [[nodiscard]] bool has_thumb() const noexcept { return thumb_.has_value(); }

  /// What the device says in the next tick. `phase`: what the thumb means; null: nothing.
  [[nodiscard]] ARTUS_REALTIME const DeviceSample& read(const OperatorPhase* phase) noexcept;
  /// What came of it.
  ARTUS_REALTIME void feel(const DeviceFeedback& feedback) noexcept;
  /// Then the needle's hand and device go on for a period, as `person` intends.
  template <class Person>
  ARTUS_REALTIME void move(const Person& person) noexcept {
    if (needle_) needle_->advance(motor_, [&person](double at) { return person.intention(at); });
  }

 private:
  std::optional<HandLoop> needle_;
  std::optional<DosingThumb> thumb_;
  DeviceSample sample_;
  Wrench motor_;
};

}  // namespace artus
