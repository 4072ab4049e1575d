// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/trainer/led_hands.h"

#include <algorithm>
#include <cmath>

#include "artus/detail/core/check.h"

namespace artus {

std::vector<LedPose> way_of(const Recording& recording, LedHand hand) {
  constexpr double kStep = 0.02;  // s
  std::vector<LedPose> way;
  const double rate = recording.head.params.haptic_rate;
  const auto every = static_cast<std::size_t>(std::max(1.0, std::round(kStep * rate)));
  for (std::size_t i = 0; i < recording.ticks.size(); i += every) {
    const DeviceSample& sample = recording.ticks[i].input.device;
    way.push_back(
        {static_cast<double>(i) / rate, hand == LedHand::needle ? sample.X_WN : sample.X_WP});
  }
  return way;
}

LedHands::LedHands(std::unique_ptr<InputDevice> own, LedHand led, std::vector<LedPose> way,
                   double period_s)
    : own_(std::move(own)), led_(led), way_(std::move(way)), period_(period_s) {
  ARTUS_REQUIRE(own_ != nullptr, "a device for the own hand");
  ARTUS_REQUIRE(!way_.empty(), "a way for the other hand");
  now_ = way_.front().pose;
}

PlainPose LedHands::wanted() noexcept {
  constexpr double kRest = 2;  // s at the end
  time_ += period_;
  if (time_ > way_.back().time + kRest) {
    time_ = way_.front().time;
    at_ = 0;
  }
  while (at_ + 1 < way_.size() && way_[at_ + 1].time <= time_) ++at_;
  if (at_ + 1 == way_.size()) return way_.back().pose;
  const LedPose& from = way_[at_];
  const LedPose& to = way_[at_ + 1];
  const double share = std::clamp((time_ - from.time) / (to.time - from.time), 0.0, 1.0);
  return blend(from.pose, to.pose, share);
}

DeviceSample LedHands::read(std::int64_t now_ns) noexcept {
  DeviceSample sample = own_->read(now_ns);
  if (led_ == LedHand::none) return sample;
  now_ = approach(now_, wanted(), HandDevice::Limits{}, period_);
  if (led_ == LedHand::needle) {
    sample.X_WN = now_;
    sample.has_needle = 1;
  } else {
    sample.X_WP = now_;
    sample.has_probe = 1;
  }
  return sample;
}

}  // namespace artus
