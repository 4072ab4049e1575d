// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/devices/kit/hand_state.h"

namespace artus::kit {
namespace {

/// Near enough for two frames of one hand.
bool agree(const Pose& a, const Pose& b) {
  constexpr double kApart = 40e-3;  // m
  constexpr double kTurned = 0.4;   // rad
  return (a.translation() - b.translation()).norm() < kApart &&
         Eigen::AngleAxisd(a.linear().transpose() * b.linear()).angle() < kTurned;
}

}  // namespace

bool Presence::take(double time, const std::optional<Pose>& pose) {
  constexpr std::size_t kBack = 3;  // frames
  if (there_ && time - seen_ > gone_after_) {
    there_ = false;
    agreeing_.clear();
  }
  if (!pose) {
    if (!there_) agreeing_.clear();
    return false;
  }
  const bool leaps = there_ && last_ && !agree(*pose, *last_);
  if (there_ && !leaps) {
    last_ = pose;
    seen_ = time;
    agreeing_.clear();
    return true;
  }
  if (!agreeing_.empty() && !agree(agreeing_.back(), *pose)) agreeing_.clear();
  agreeing_.push_back(*pose);
  if (agreeing_.size() < kBack) return false;
  agreeing_.clear();
  there_ = true;
  last_ = pose;
  seen_ = time;
  return true;
}

const Pose* Presence::recent(double time) const {
  constexpr double kRecent = 0.25;  // s
  return there_ && last_ && time - seen_ <= kRecent ? &*last_ : nullptr;
}

}  // namespace artus::kit
