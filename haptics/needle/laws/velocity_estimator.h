// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>

#include "artus/detail/core/check.h"
#include "artus/detail/haptics/needle/laws/motion.h"

namespace artus {

/// Velocity of a sampled position. Methods that need none (the tracking wall) are better off; these
/// exist for those that do, and to compare. Noise and lag: experiment "velocity-estimators".
class VelocityEstimator {
 public:
  VelocityEstimator() = default;
  VelocityEstimator(const VelocityEstimator&) = default;
  VelocityEstimator(VelocityEstimator&&) = default;
  VelocityEstimator& operator=(const VelocityEstimator&) = default;
  VelocityEstimator& operator=(VelocityEstimator&&) = default;
  virtual ~VelocityEstimator() = default;

  /// At rest at x, m.
  ARTUS_REALTIME virtual void reset(double x) noexcept = 0;
  /// Takes the newest position, m; returns the velocity, m/s.
  ARTUS_REALTIME virtual double step(double x) noexcept = 0;
};

/// (x now - x a window ago) / window. Source [Constantinescu2005] by [Alamilla2020] section 2.1.2.
class WindowedDifference final : public VelocityEstimator {
 public:
  /// Requires: window >= dt > 0, s; at most 255 periods.
  WindowedDifference(double window, double dt) noexcept
      : samples_(window, dt), duration_(samples_.duration(dt)) {}
  ARTUS_REALTIME void reset(double x) noexcept override { samples_.reset(x); }
  ARTUS_REALTIME double step(double x) noexcept override {
    return (x - samples_.push(x)) / duration_;
  }

 private:
  SampleWindow<double> samples_;
  double duration_;
};

/// The backward Taylor form: counts of a fixed period, combined so that their first `order` terms
/// cancel. Higher orders lag less and magnify the encoder's noise. Source [Brown1992] by
/// [Alamilla2020] section 2.1.2.
class TaylorEstimator final : public VelocityEstimator {
 public:
  /// Requires: order 1, 2 or 3; period >= dt > 0, s; at most 255 sampling periods.
  TaylorEstimator(int order, double period, double dt) noexcept;
  ARTUS_REALTIME void reset(double x) noexcept override;
  ARTUS_REALTIME double step(double x) noexcept override;

 private:
  std::array<double, 4> weights_{};  // of the positions 0, 1, 2, 3 periods ago, 1/s
  std::array<SampleWindow<double>, 3> ago_;
};

/// Levant's robust exact differentiator (super-twisting): exact without noise when the acceleration
/// stays below `max_acceleration`. Source [Levant1998], gains 1.5 and 1.1 of the same paper.
class LevantDifferentiator final : public VelocityEstimator {
 public:
  /// Requires: max_acceleration > 0 m/s^2, dt > 0 s.
  LevantDifferentiator(double max_acceleration, double dt) noexcept
      : bound_(max_acceleration), dt_(dt) {}
  ARTUS_REALTIME void reset(double x) noexcept override;
  ARTUS_REALTIME double step(double x) noexcept override;

 private:
  double bound_;
  double dt_;
  double position_ = 0;
  double velocity_ = 0;
};

}  // namespace artus
