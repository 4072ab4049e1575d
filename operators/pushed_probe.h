// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cmath>

#include "artus/core/geometry.h"
#include "artus/detail/haptics/wrench.h"

namespace artus {

/// A mass in a hand that is a spring, a damper and a steady push.
struct PushedProbeParams {
  double mass = 0.3;     ///< kg
  double stiffness = 0;  ///< N/m toward where the hand wants it
  double damping = 3;    ///< N s/m against motion
  double push = 0;       ///< N along the face's z
  double encoder = 0;    ///< m that the measured place is rounded to; 0: exact
};

/// The least hand that a contact must be stable with: it has no reflex, no tremor and no will to
/// hold on. The face turns as it is led. Deterministic.
class PushedProbe {
 public:
  /// `period`: s of a tick. Requires: a mass above 0.
  PushedProbe(const PushedProbeParams& params, double period, const Pose& start)
      : params_(params), period_(period), X_JP_(start) {}

  /// One tick with `felt` held, toward `wanted`, frame J.
  void advance(const Wrench& felt, const Pose& wanted) {
    constexpr int kSteps = 10;
    const double h = period_ / kSteps;
    const Vec3 before = X_JP_.translation();
    for (int i = 0; i < kSteps; ++i) {
      const Vec3 force = felt.force + params_.push * X_JP_.linear().col(2) +
                         params_.stiffness * (wanted.translation() - X_JP_.translation());
      v_ = (v_ + h / params_.mass * force) / (1 + h * params_.damping / params_.mass);
      X_JP_.translation() += h * v_;
    }
    const Eigen::AngleAxisd turn(wanted.linear() * X_JP_.linear().transpose());
    X_JP_.linear() = wanted.linear();
    given_ +=
        felt.force.dot(X_JP_.translation() - before) + turn.angle() * felt.torque.dot(turn.axis());
  }

  void push(double force) noexcept { params_.push = force; }  ///< N, PushedProbeParams::push
  [[nodiscard]] const Pose& pose() const noexcept { return X_JP_; }
  /// As an encoder gives it.
  [[nodiscard]] Pose measured() const {
    Pose pose = X_JP_;
    if (params_.encoder > 0)
      pose.translation() = (pose.translation() / params_.encoder).array().round() * params_.encoder;
    return pose;
  }
  [[nodiscard]] const Vec3& velocity() const noexcept { return v_; }  ///< m/s
  /// J that what was felt gave the hand since the start.
  [[nodiscard]] double given() const noexcept { return given_; }

 private:
  PushedProbeParams params_;
  double period_;
  Pose X_JP_;
  Vec3 v_ = Vec3::Zero();
  double given_ = 0;
};

}  // namespace artus
