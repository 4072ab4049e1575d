// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/session/injecting_device.h"

#include <cmath>

#include "artus/detail/haptics/needle/needle_contact.h"
#include "artus/detail/simulation/syringe_core.h"

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
    : plan_(plan),
      period_(1 / rate_hz),
      person_(plan.entry_W, plan.direction_W, kBeforeSkin, phases_of(plan)),
      loop_({rate_hz, physics_rate(rate_hz)}, device, hand, person_.start()),
      thumb_({SyringeCore::kCoupling, SyringeCore::kMaxForce}),
      dose_(plan.plunger, plan.volume) {
  ARTUS_REQUIRE(std::abs(plan.direction_W.norm() - 1) < 1e-9, "the direction must have length 1");
  ARTUS_REQUIRE(plan.speed > 0 && plan.target <= plan.deepest,
                "speed must be above 0 and the target no deeper than the deepest point");
  ARTUS_REQUIRE(plan.rate > 0, "the dose's rate must be above 0");
  sample_.X_WP = to_plain(plan.X_WP);
  sample_.state = PeerState::alive;
  sample_.has_needle = 1;
  sample_.has_probe = 1;
}

OperatorView InjectingDevice::view() const noexcept {
  const Vec3 meant = person_.intention(loop_.time()).X_JN.translation();
  const double lag = (meant - loop_.motion().X_JN.translation()).dot(plan_.direction_W);
  OperatorView view;
  view.given = dose_.done();
  view.bone = static_cast<ContactState>(contact_) == ContactState::bone && lag > kBoneFelt;
  return view;
}

void InjectingDevice::press_plunger() noexcept {
  const bool meant = phase() == Phase::rest;
  if (!meant) dose_.begin(felt_.given);
  PlungerState plunger;
  plunger.travel = felt_.travel;
  plunger.pressure = felt_.pressure;
  const PlungerInput request = thumb_.step(meant ? dose_.present(person_.present()) : nullptr,
                                           plunger, plan_.plunger.syringe.area(), period_);
  sample_.plunger = request.stiffness > 0 ? PlungerSign::travel : PlungerSign::force;
  sample_.plunger_travel = request.position;
  sample_.plunger_force = request.force;
  const bool pushes = meant && (felt_.flow > ThumbDose::kFlows || thumb_.strains());
  dose_.step(pushes, felt_.given, felt_.pressure, felt_.tip_pressure, felt_.flow, period_);
}

DeviceSample InjectingDevice::read(std::int64_t now_ns) noexcept {
  person_.observe(loop_.time(), loop_.motion().X_JN, view());
  if (person_.done()) person_.begin_again(loop_.time());
  if (plan_.volume > 0) press_plunger();
  loop_.advance(motor_, [this](double time) { return person_.intention(time); });
  sample_.X_WN = to_plain(loop_.measured());
  sample_.time_ns = now_ns;
  ++sample_.number;
  return sample_;
}

void InjectingDevice::write(const DeviceFeedback& feedback) noexcept {
  motor_.force = Vec3(feedback.force[0], feedback.force[1], feedback.force[2]);
  motor_.torque = Vec3(feedback.torque[0], feedback.torque[1], feedback.torque[2]);
  contact_ = feedback.contact;
  felt_ = feedback.plunger;
}

}  // namespace artus
