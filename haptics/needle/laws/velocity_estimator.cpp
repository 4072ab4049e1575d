// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/haptics/needle/laws/velocity_estimator.h"

#include <cmath>

namespace artus {

TaylorEstimator::TaylorEstimator(int order, double period, double dt) noexcept
    : ago_{SampleWindow<double>(period, dt), SampleWindow<double>(2 * period, dt),
           SampleWindow<double>(3 * period, dt)} {
  const double t = ago_[0].duration(dt);
  if (order == 1) {
    weights_ = {1 / t, -1 / t, 0, 0};
  } else if (order == 2) {
    weights_ = {1.5 / t, -2 / t, 0.5 / t, 0};
  } else {
    weights_ = {11.0 / 6 / t, -3 / t, 1.5 / t, -1.0 / 3 / t};
  }
}

void TaylorEstimator::reset(double x) noexcept {
  for (auto& window : ago_) window.reset(x);
}

double TaylorEstimator::step(double x) noexcept {
  double v = weights_[0] * x;
  for (std::size_t i = 0; i < ago_.size(); ++i) v += weights_[i + 1] * ago_[i].push(x);
  return v;
}

void LevantDifferentiator::reset(double x) noexcept {
  position_ = x;
  velocity_ = 0;
}

double LevantDifferentiator::step(double x) noexcept {
  const double error = position_ - x;
  const double sign = error > 0 ? 1 : error < 0 ? -1 : 0;
  const double rate = velocity_ - 1.5 * std::sqrt(bound_ * std::abs(error)) * sign;
  position_ += dt_ * rate;
  velocity_ -= dt_ * 1.1 * bound_ * sign;
  return velocity_;
}

}  // namespace artus
