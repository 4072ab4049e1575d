// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/haptics/needle/laws/hard_contact.h"

#include <algorithm>
#include <cmath>

#include "artus/detail/core/units.h"

namespace artus {
namespace {
constexpr double kLongAgo = 1e9;  // s
}  // namespace

double decaying_sinusoid(const DecayingSinusoidParams& params, double t) noexcept {
  if (t <= 0 || t >= params.duration) return 0;
  return params.amplitude * std::exp(std::log(0.01) * t / params.duration) *
         std::sin(kTwoPi * params.frequency * t);
}

void HardContact::reset(double depth) noexcept {
  touching_ = false;
  speed_ = 0;
  time_ = kLongAgo;
  last_x_ = depth;
}

void HardContact::take_line(double by) noexcept {
  last_x_ += by;
  touched_at_ += by;
}

Wrench HardContact::step(const NeedleTick& tick) noexcept {
  const double beyond = tick.depth - tick.bone_depth;
  const double moved = tick.depth - last_x_;
  last_x_ = tick.depth;
  time_ = std::min(time_ + tick.dt, kLongAgo);
  if (!touching_ && beyond > 0) {
    touching_ = true;
    speed_ = tick.incoming_speed;
    time_ = moved > beyond ? beyond / moved * tick.dt : 0;  // when within the tick it was reached
  }
  if (beyond > 0) touched_at_ = tick.depth;
  if (std::abs(tick.depth - touched_at_) > params_.rearm_distance) touching_ = false;
  double force = 0;
  if (params_.law == HardLaw::decaying_sinusoid) {
    force = speed_ * decaying_sinusoid(params_.sinusoid, time_);
  } else if (time_ < std::max(params_.impulse.duration, tick.dt)) {
    const double length = std::max(params_.impulse.duration, tick.dt);
    force = (params_.impulse.restitution + 1) * params_.impulse.mass * speed_ / length;
  }
  return {-force * tick.axis, Vec3::Zero()};
}

}  // namespace artus
