// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <algorithm>
#include <cmath>
#include <limits>

#include "artus/detail/core/check.h"
#include "artus/detail/haptics/wrench.h"

namespace artus {

struct PassivityParams {
  bool control = false;     ///< whether damping is added when the account goes above zero
  double max_damping = 20;  ///< N s/m; assumed: below m / T of a 0.1 kg device at 1 kHz
};

/// The account of a probe's hand: its contact is passive but for what corrections may give.
/// Assumed.
inline constexpr PassivityParams kProbePassivity{true, 12};
inline constexpr double kProbeDampingForce = 0.2;  // N

/// Counts the energy that the commanded forces have given to the hand, from positions alone: over a
/// period the force is constant (zero-order hold), so force times displacement is exact. Above zero
/// the simulation was not passive; the optional controller then takes the excess back by damping.
/// Torques are not counted. Source [Hannaford2002].
class PassivityObserver {
 public:
  /// `max_force`: N of the damping; an encoder's step at a high rate looks like a fast motion.
  PassivityObserver(const PassivityParams& params, double dt,
                    double max_force = std::numeric_limits<double>::infinity()) noexcept
      : params_(params), dt_(dt), max_force_(max_force) {}

  /// Poses are missing for a while (a fault): the account stays, the gap is not counted.
  ARTUS_REALTIME void pause() noexcept { started_ = false; }

  /// `tip`: m, now. `wanted`: N, the force about to be commanded; returns it, damped if need be.
  /// Call observe() with what was really sent.
  [[nodiscard]] ARTUS_REALTIME Vec3 step(const Vec3& tip, const Vec3& wanted) noexcept {
    const Vec3 moved = started_ ? Vec3(tip - last_tip_) : Vec3(Vec3::Zero());
    energy_ += sent_.dot(moved);
    last_tip_ = tip;
    started_ = true;
    const double square = moved.squaredNorm();
    if (!params_.control || energy_ <= 0 || square == 0) return wanted;
    const double damping = std::min(
        {energy_ * dt_ / square, params_.max_damping, max_force_ * dt_ / std::sqrt(square)});
    return wanted - damping / dt_ * moved;
  }
  ARTUS_REALTIME void observe(const Vec3& sent) noexcept { sent_ = sent; }

  [[nodiscard]] double energy_to_hand() const noexcept { return energy_; }  ///< J

 private:
  PassivityParams params_;
  double dt_;
  double max_force_;
  bool started_ = false;
  Vec3 last_tip_ = Vec3::Zero();
  Vec3 sent_ = Vec3::Zero();
  double energy_ = 0;
};

}  // namespace artus
