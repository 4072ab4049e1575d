// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/haptics/needle/laws/lugre_friction.h"

#include <algorithm>
#include <cmath>

namespace artus {
namespace {
constexpr std::array<LugreParams, 4> kSets{{
    {1.326e3, 1.423e3, 1.04e-1, 0.628, 0.045, 0.256e3, 0.020},
    {1.419e3, 1.312e3, 1.0, 0.913, 0.033, 0.152e3, 0.020},
    {2.469e3, 0.845e3, 2.76e-1, 1.386, 0.084, 0.079e3, 0.040},
    {2.592e3, 0.879e3, 2.40, 1.763, 0.052, 0.075e3, 0.040},
}};
}  // namespace

const std::array<LugreParams, 4>& lugre_sets() noexcept {
  return kSets;
}

double lugre_level(const LugreParams& params, double v) noexcept {
  return params.mu_c + (params.mu_s - params.mu_c) * std::exp(-params.alpha * std::abs(v));
}

double LugreBristle::advance(const LugreParams& params, double moved, double level) noexcept {
  const double steady = std::copysign(level, moved);
  load_ = steady + (load_ - steady) * std::exp(-params.sigma0 * std::abs(moved / steady));
  return load_;
}

void LugreBristle::relax(const LugreParams& params, double v, double dt) noexcept {
  const double level = lugre_level(params, v);
  const double excess = std::abs(load_) - level;
  if (excess <= 0) return;
  load_ = std::copysign(level + excess * std::exp(-dt / params.relaxation_time), load_);
}

double LugreBristle::step(const LugreParams& params, double moved, double v, double dt,
                          double sigma1) noexcept {
  const double before = load_;
  const double rate =
      (advance(params, moved, lugre_level(params, v)) - before) / (params.sigma0 * dt);
  return load_ + std::min(sigma1, params.sigma1) * rate + params.sigma2 * moved / dt;
}

void LugreFriction::reset(double depth) noexcept {
  bristle_.reset();
  deflections_.reset(0);
  depths_.reset(depth);
  last_x_ = depth;
}

void LugreFriction::take_line(double by) noexcept {
  last_x_ += by;
  depths_.shift(by);
}

Wrench LugreFriction::step(const NeedleTick& tick) noexcept {
  const double moved = tick.depth - last_x_;
  last_x_ = tick.depth;
  const double normal = tick.sum_over_shaft([](const Haptic& h) {
    return h.hard ? 0.0 : h.cutting_force * h.friction;
  }) / params_.length;
  LugreParams limited = params_;
  if (normal > 0) {
    limited.sigma0 = std::min(params_.sigma0, params_.stiffness_limit / normal);
    limited.sigma1 = std::min(params_.sigma1, params_.damping_limit / normal);
  }
  const double level = std::max(lugre_level(limited, tick.velocity), std::abs(bristle_.load()));
  bristle_.advance(limited, moved, level);
  bristle_.relax(limited, tick.velocity, tick.dt);
  const double load = bristle_.load();
  const double z = bristle_.deflection(limited);
  const double window = deflections_.duration(tick.dt);
  const double bristle_rate = (z - deflections_.push(z)) / window;
  const double speed = (tick.depth - depths_.push(tick.depth)) / window;
  const double ratio = load + limited.sigma1 * bristle_rate + params_.sigma2 * speed;
  return {-normal * ratio * tick.axis, Vec3::Zero()};
}

}  // namespace artus
