// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/session/injecting_device.h"

#include <cmath>

#include "artus/haptics/needle/needle_contact.h"

namespace artus {
namespace {

constexpr double kBeforeSkin = -12e-3;  // m, tip before the skin at start and end
constexpr double kWait = 0.5;           // s outside; longer than the guard's ramp
constexpr double kRest = 0.8;           // s at the target; assumed, as in three-injections
constexpr double kPress = 0.25;         // s on the bone; assumed
constexpr double kBoneFelt = 2.5e-3;    // m that the needle lags behind the hand on bone: 4 N
constexpr double kFastOut = 2.0;        // withdrawal's speed over insertion's

/// Steps of hand and device within a tick: stiff enough at 4 kHz, and cheap.
double physics_rate(double rate_hz) {
  return rate_hz * std::max(1.0, std::ceil(4000 / rate_hz));
}

Pose start_of(const InjectionPlan& plan) {
  return make_pose(plan.entry_W + kBeforeSkin * plan.direction_W, plan.direction_W,
                   plan.X_WP.linear().col(1));
}

}  // namespace

InjectingDevice::InjectingDevice(const InjectionPlan& plan, const DeviceLimits& device,
                                 double rate_hz, const HandParams& hand)
    : plan_(plan),
      x_hint_(plan.X_WP.linear().col(1)),
      loop_({rate_hz, physics_rate(rate_hz)}, device, hand, start_of(plan)),
      reference_(kBeforeSkin) {
  ARTUS_REQUIRE(std::abs(plan.direction_W.norm() - 1) < 1e-9, "the direction must be a unit");
  ARTUS_REQUIRE(plan.speed > 0 && plan.target <= plan.deepest, "an injection goes somewhere");
  sample_.X_WP = to_plain(plan.X_WP);
  sample_.state = PeerState::alive;
  sample_.has_needle = 1;
  sample_.has_probe = 1;
}

double InjectingDevice::speed() const noexcept {
  switch (phase_) {
    case Phase::to_target:
    case Phase::to_bone:
      return plan_.speed;
    case Phase::withdraw:
      return -kFastOut * plan_.speed;
    case Phase::wait:
    case Phase::rest:
    case Phase::press:
      break;
  }
  return 0;
}

void InjectingDevice::go_on(Phase phase) noexcept {
  const double time = loop_.time();
  reference_ += speed() * (time - phase_time_);
  phase_ = phase;
  phase_time_ = time;
}

void InjectingDevice::decide() noexcept {
  const double elapsed = loop_.time() - phase_time_;
  const double wanted = reference_ + speed() * elapsed;
  const double depth = (loop_.motion().X_JN.translation() - plan_.entry_W).dot(plan_.direction_W);
  const bool bone =
      static_cast<ContactState>(contact_) == ContactState::bone && wanted - depth > kBoneFelt;
  switch (phase_) {
    case Phase::wait:
      if (elapsed >= kWait) go_on(Phase::to_target);
      break;
    case Phase::to_target:
      if (bone)
        go_on(Phase::press);
      else if (wanted >= plan_.target)
        go_on(Phase::rest);
      break;
    case Phase::rest:
      if (elapsed >= kRest) go_on(Phase::to_bone);
      break;
    case Phase::to_bone:
      if (bone || wanted >= plan_.deepest) go_on(Phase::press);
      break;
    case Phase::press:
      if (elapsed >= kPress) go_on(Phase::withdraw);
      break;
    case Phase::withdraw:
      if (wanted <= kBeforeSkin) {
        go_on(Phase::wait);
        reference_ = kBeforeSkin;
      }
      break;
  }
}

Intention InjectingDevice::intention(double time) const noexcept {
  Intention want;
  const double reference = reference_ + speed() * (time - phase_time_);
  want.X_JN = make_pose(plan_.entry_W + reference * plan_.direction_W, plan_.direction_W, x_hint_);
  want.velocity = speed() * plan_.direction_W;
  want.hold = phase_ == Phase::rest;
  return want;
}

DeviceSample InjectingDevice::read(std::int64_t now_ns) noexcept {
  decide();
  loop_.advance(motor_, [this](double time) { return intention(time); });
  sample_.X_WN = to_plain(loop_.measured());
  sample_.time_ns = now_ns;
  ++sample_.number;
  return sample_;
}

void InjectingDevice::write(const DeviceFeedback& feedback) noexcept {
  motor_.force = Vec3(feedback.force[0], feedback.force[1], feedback.force[2]);
  motor_.torque = Vec3(feedback.torque[0], feedback.torque[1], feedback.torque[2]);
  contact_ = feedback.contact;
}

}  // namespace artus
