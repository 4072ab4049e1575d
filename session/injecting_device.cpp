// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/session/injecting_device.h"

#include <cmath>

#include "artus/detail/haptics/needle/needle_contact.h"

namespace artus {
namespace {

constexpr double kBeforeSkin = -12e-3;  // m, tip before the skin at start and end
constexpr double kWait = 0.5;           // s outside; longer than the guard's ramp
constexpr double kRest = 0.8;           // s at the target; assumed, as in three-injections
constexpr double kPress = 0.25;         // s on the bone; assumed
constexpr double kOverTime = 20;        // s beyond twice its time that a dose may take; assumed
constexpr double kBoneFelt = 2.5e-3;    // m that the needle lags behind the hand on bone: 4 N
constexpr double kFastOut = 2.0;        // withdrawal's speed over insertion's

/// Steps of hand and device within a tick: stiff enough at 4 kHz, and cheap.
double physics_rate(double rate_hz) {
  return rate_hz * std::max(1.0, std::ceil(4000 / rate_hz));
}

std::vector<OperatorPhase> phases_of(const InjectionPlan& plan) {
  OperatorPhase to_target = push_to(plan.target, plan.speed);
  to_target.stop_at_bone = true;
  OperatorPhase to_bone = push_to(plan.deepest, plan.speed);
  to_bone.goal = OperatorPhase::Goal::bone;
  OperatorPhase at_target = stay(kRest);
  if (plan.volume > 0) {
    at_target = stay(2 * plan.volume / plan.rate + kOverTime);
    at_target.thumb_rate = plan.rate;
    at_target.until_given = true;
  }
  return {press(kWait), to_target,     at_target,
          to_bone,      press(kPress), pull_to(kBeforeSkin, kFastOut * plan.speed)};
}

}  // namespace

InjectingDevice::InjectingDevice(const InjectionPlan& plan, const DeviceLimits& device,
                                 double rate_hz, const HandParams& hand)
    : plan_(plan), person_(plan.entry_W, plan.direction_W, kBeforeSkin, phases_of(plan)) {
  ARTUS_REQUIRE(std::abs(plan.direction_W.norm() - 1) < 1e-9, "the direction must have length 1");
  ARTUS_REQUIRE(plan.speed > 0 && plan.target <= plan.deepest,
                "speed must be above 0 and the target no deeper than the deepest point");
  ARTUS_REQUIRE(plan.rate > 0, "the dose's rate must be above 0");
  hands_.take_up(HandLoop({rate_hz, physics_rate(rate_hz)}, device, hand, person_.start()));
  if (plan.volume > 0) hands_.set_thumb(DosingThumb(plan.plunger, plan.volume, rate_hz));
  hands_.hold_probe(plan.X_WP);
}

OperatorView InjectingDevice::view(const DeviceFeedback& feedback) const noexcept {
  const HandLoop& needle = hands_.needle();
  const Vec3 meant = person_.intention(needle.time()).X_JN.translation();
  const double lag = (meant - needle.motion().X_JN.translation()).dot(plan_.direction_W);
  OperatorView view;
  view.given = hands_.has_thumb() && hands_.thumb().done();
  view.bone = static_cast<ContactState>(feedback.contact) == ContactState::bone && lag > kBoneFelt;
  return view;
}

DeviceSample InjectingDevice::read(std::int64_t now_ns) noexcept {
  DeviceSample sample = hands_.read(person_.present());
  sample.time_ns = now_ns;
  return sample;
}

void InjectingDevice::write(const DeviceFeedback& feedback) noexcept {
  hands_.feel(feedback);
  const HandLoop& needle = hands_.needle();
  const bool ended =
      person_.observe(needle.time(), needle.motion().X_JN, view(feedback)) != nullptr;
  if (ended && hands_.has_thumb()) hands_.thumb().begin();
  if (person_.done()) person_.begin_again(needle.time());
  hands_.move(person_);
}

}  // namespace artus
