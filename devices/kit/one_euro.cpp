// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/devices/kit/one_euro.h"

#include <cmath>
#include <numbers>

namespace artus::kit {
namespace {

/// Share of the new value by a corner frequency in Hz.
double share(double cutoff, double dt) {
  const double tau = 1 / (2 * std::numbers::pi * cutoff);
  return 1 / (1 + tau / dt);
}

}  // namespace

Pose PoseFilter::take(double time, const Pose& X_AB, const Vec3& point_B) {
  const Vec3 raw = X_AB * point_B;
  const Eigen::Quaterniond turn(X_AB.linear());
  if (!last_ || !(time > last_->time)) {
    last_ = Last{time, raw, raw, Vec3::Zero(), turn, turn, 0};
    return X_AB;
  }
  const double dt = time - last_->time;
  const double slow = share(params_.speed_cutoff, dt);
  last_->speed += slow * ((raw - last_->raw) / dt - last_->speed);
  last_->turning += slow * (turn.angularDistance(last_->raw_turn) / dt - last_->turning);
  const double by_place = params_.slowest + params_.beta * last_->speed.norm();
  const double by_turn = params_.slowest + params_.beta * params_.arm * last_->turning;
  last_->point += share(by_place, dt) * (raw - last_->point);
  last_->turn = last_->turn.slerp(share(by_turn, dt), turn).normalized();
  last_->raw = raw;
  last_->raw_turn = turn;
  last_->time = time;
  Pose out = Pose::Identity();
  out.linear() = last_->turn.toRotationMatrix();
  out.translation() = last_->point - out.linear() * point_B;
  return out;
}

}  // namespace artus::kit
