// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/operators/simulated_hand.h"

#include <cmath>

#include "artus/detail/core/noise.h"
#include "artus/detail/core/units.h"
#include "artus/detail/haptics/needle/laws/orientation_torque.h"

namespace artus {
namespace {}

SimulatedHand::SimulatedHand(const HandParams& params) : params_(params) {
  std::uint64_t index = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t i = 0; i < kSines; ++i) {
      const double f = params.tremor_low_hz + (params.tremor_high_hz - params.tremor_low_hz) *
                                                  uniform_noise(params.seed, index++);
      frequency_[axis][i] = kTwoPi * f;
      phase_[axis][i] = kTwoPi * uniform_noise(params.seed, index++);
    }
  }
}

Vec3 SimulatedHand::tremor(double t) const noexcept {
  Vec3 sum = Vec3::Zero();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t i = 0; i < kSines; ++i) {
      sum[static_cast<Eigen::Index>(axis)] += std::sin(frequency_[axis][i] * t + phase_[axis][i]);
    }
  }
  return sum * (params_.tremor_rms * std::sqrt(2.0 / kSines));
}

Wrench SimulatedHand::wrench(double t, const Intention& intention, const NeedleMotion& needle,
                             const Vec3& felt) const noexcept {
  if (!intention.grip) return {};
  const Vec3 off = intention.X_JN.translation() + tremor(t) - needle.X_JN.translation();
  const Vec3 turn = orientation_error(Eigen::Quaterniond(needle.X_JN.linear()),
                                      Eigen::Quaterniond(intention.X_JN.linear()));
  const Vec3 balance = intention.hold ? Vec3(-felt) : Vec3(Vec3::Zero());
  return {
      params_.stiffness * off + params_.damping * (intention.velocity - needle.velocity) + balance,
      params_.turn_stiffness * turn - params_.turn_damping * needle.angular_velocity};
}

}  // namespace artus
