// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <memory>
#include <string_view>
#include <utility>
#include <vector>

#include "artus/detail/session/hand_device.h"
#include "artus/session/recording.h"

namespace artus {

/// Which hand somebody else leads while a person has the other alone.
enum class LedHand { none, needle, probe };

/// Where a hand was at a time of a run.
struct LedPose {
  double time = 0;  ///< s since the run began
  PlainPose pose;
};
/// A hand's way through a recording, every 20 ms. Empty: it has no ticks.
[[nodiscard]] std::vector<LedPose> way_of(const Recording& recording, LedHand hand);

/// A person's device one hand of which goes the way of another run, again and again with 2 s of
/// rest between, no faster than a hand moves: to learn one hand at a time.
class LedHands final : public InputDevice {
 public:
  /// `period_s`: of a tick. Requires: a device, poses by time, one at least.
  LedHands(std::unique_ptr<InputDevice> own, LedHand led, std::vector<LedPose> way,
           double period_s);

  [[nodiscard]] ARTUS_REALTIME DeviceSample read(std::int64_t now_ns) noexcept override;
  ARTUS_REALTIME void write(const DeviceFeedback& feedback) noexcept override {
    own_->write(feedback);
  }
  [[nodiscard]] std::vector<std::string> repair_connection() override {
    return own_->repair_connection();
  }
  [[nodiscard]] std::string_view name() const noexcept override { return own_->name(); }

 private:
  [[nodiscard]] ARTUS_REALTIME PlainPose wanted() noexcept;

  std::unique_ptr<InputDevice> own_;
  LedHand led_;
  std::vector<LedPose> way_;
  double period_;       // s
  double time_ = 0;     // s of the way
  std::size_t at_ = 0;  // of way_
  PlainPose now_;
};

}  // namespace artus
