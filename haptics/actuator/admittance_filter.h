// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cmath>
#include <numbers>

#include "artus/detail/haptics/actuator/control_law.h"

namespace artus {

/// A first-order low-pass, exact for held inputs.
class LowPass {
 public:
  /// Requires: dt > 0 s; a cutoff of 0 Hz or less passes everything.
  LowPass(double cutoff, double dt) noexcept
      : share_(cutoff > 0 ? 1 - std::exp(-2 * std::numbers::pi * cutoff * dt) : 1) {}
  ARTUS_REALTIME void reset(double value) noexcept { value_ = value; }
  ARTUS_REALTIME double step(double value) noexcept {
    value_ += share_ * (value - value_);
    return value_;
  }

 private:
  double share_;
  double value_ = 0;
};

/// The outer loop of the admittance laws: x_c = x_0 - F_m / K_c. Without it the reference is x_0.
/// Source [Alamilla2020] (3.10), (3.11); the low-pass of the force is an addition.
class Admittance {
 public:
  Admittance(bool active, double cutoff, double dt) noexcept
      : active_(active), filter_(cutoff, dt) {}
  ARTUS_REALTIME void reset(const ControlInput& in) noexcept { filter_.reset(in.measured.force); }
  /// x_c, m; x_0 for a stiffness that is not positive.
  ARTUS_REALTIME double step(const ControlInput& in) noexcept {
    if (!active_) return in.target.y;
    const double force = filter_.step(in.measured.force);
    return in.target.stiffness > 0 ? in.target.y - force / in.target.stiffness : in.target.y;
  }

 private:
  bool active_;
  LowPass filter_;
};

}  // namespace artus
