// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/haptics/needle/laws/tracking_wall.h"

#include <algorithm>
#include <cmath>

namespace artus {

void TrackingWall::reset(double depth) noexcept {
  start(depth, depth);
}

void TrackingWall::start(double w0, double depth) noexcept {
  wall_ = w0;
  cut_ = w0;
  stiffness_ = 0;
  cutting_limit_ = 0;
  attracted_limit_ = 0;
  settle_left_ = params_.settling_time;
  last_x_ = depth;
  last_force_ = 0;
  energy_ = 0;
}

void TrackingWall::take_line(double by, double kept) noexcept {
  wall_ += by;
  last_x_ += by;
  cut_ += by;
  cut_ -= (1 - kept) * std::max(0.0, cut_ - last_x_);
}

void TrackingWall::settle(const NeedleTick& tick, double x) noexcept {
  const double still = tick.stillness * tick.dt;
  const double moving = tick.dt - still;
  // A straight line for a needle at rest; one that trembles is met where it is, without a step.
  if (still > 0) wall_ += (x - wall_) * (settle_left_ > still ? still / settle_left_ : 1);
  settle_left_ += moving * params_.settling_time / params_.moving_time - still;
  settle_left_ = std::clamp(settle_left_, 0.0, params_.settling_time);
}

void TrackingWall::follow_limits(const NeedleTick& tick) noexcept {
  const double share = std::exp(-tick.dt / params_.fall_time);
  const auto follow = [share](double& limit, double layer) {
    limit = layer + std::max(0.0, limit - layer) * share;
  };
  follow(cutting_limit_, tick.layer.tissue.cutting_force);
  follow(attracted_limit_, tick.layer.tissue.attracted_force);
}

double TrackingWall::soft_force(const NeedleTick& tick, double x) noexcept {
  const Haptic& layer = tick.layer.tissue;
  const double stiffness = std::max(layer.wall_stiffness, 1e-6);
  if (stiffness_ > 0 && stiffness != stiffness_) {
    wall_ = x + (wall_ - x) * stiffness_ / stiffness;  // keep the force, move the wall
    if (wall_ < x) cut_ = std::min(cut_, wall_);
  }
  stiffness_ = stiffness;
  settle(tick, x);
  follow_limits(tick);
  const double floor = x <= cut_ ? x : std::max(cut_, x - cutting_limit_ / stiffness);
  // Tissue cannot be drawn out by more than the needle is in: the hold ends at the skin, not at a
  // tick.
  const double ceiling = x + std::min(attracted_limit_ / stiffness, std::max(0.0, x));
  wall_ = std::min(std::max(wall_, floor), ceiling);
  cut_ = std::max(cut_, std::min(wall_, x));
  return stiffness * (wall_ - x);
}

Wrench TrackingWall::step(const NeedleTick& tick) noexcept {
  const double x = tick.depth;
  const double moved = x - last_x_;
  energy_ -= last_force_ * moved;
  const double beyond = std::max(0.0, x - tick.bone_depth);
  double force = soft_force(tick, x - beyond);
  if (beyond > 0) {
    const Haptic& bone = tick.bone.tissue;
    force = std::max(force - bone.wall_stiffness * beyond, std::min(force, -bone.cutting_force));
  }
  if (x < 0) force = 0;
  // On the way back a sampled spring gives more than it took; the account forbids it.
  if (force * moved > 0) {
    const double allowed = std::max(0.0, energy_) / (2 * std::abs(moved));
    force = std::clamp(force, -allowed, allowed);
  }
  last_x_ = x;
  last_force_ = force;
  return {force * tick.axis, Vec3::Zero()};
}

}  // namespace artus
