// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <cstdint>

#include "artus/core/geometry.h"
#include "artus/detail/haptics/wrench.h"

namespace artus {

/// A hand that steers a needle: spring and damper to an intended path. Order of size of a braced
/// hand on a stylus, [Hajian1997] and [Speich2005]; the values themselves are assumed.
struct HandParams {
  double stiffness = 1500;     ///< N/m
  double damping = 30;         ///< N s/m
  double mass = 0.1;           ///< kg, moves with the device
  double turn_stiffness = 12;  ///< N m/rad
  double turn_damping = 0.15;  ///< N m s/rad
  double inertia = 2e-3;       ///< kg m^2, of hand, syringe and device's wrist
  double tremor_rms = 20e-6;   ///< m per axis; [Riviere1996]: tens of micrometres in surgery
  double tremor_low_hz = 8;    ///< Hz
  double tremor_high_hz = 12;  ///< Hz
  double reflex_time = 0.03;   ///< s, lag of balancing what is felt; a spinal reflex's, assumed
  double release_time = 0.05;  ///< s in which the fingers open or close; assumed
  std::uint64_t seed = 1;
};

/// What the hand wants at an instant.
struct Intention {
  Pose X_JN = Pose::Identity();  ///< intended needle pose
  Vec3 velocity = Vec3::Zero();  ///< m/s, of the intended tip
  bool hold = false;             ///< means to stay: also balances what it feels
  bool grip = true;              ///< false: let go
};

/// Where a needle is and how it moves.
struct NeedleMotion {
  Pose X_JN = Pose::Identity();
  Vec3 velocity = Vec3::Zero();          ///< m/s, of the tip
  Vec3 angular_velocity = Vec3::Zero();  ///< rad/s
};

class SimulatedHand {
 public:
  explicit SimulatedHand(const HandParams& params);

  /// What the hand does to the needle at time `t`, s. `felt`: N, the device's force as felt,
  /// lagged.
  [[nodiscard]] Wrench wrench(double t, const Intention& intention, const NeedleMotion& needle,
                              const Vec3& felt = Vec3::Zero()) const noexcept;

  /// The tremor's displacement at `t`, m: a sum of sines in the band, a pure function of the seed.
  [[nodiscard]] Vec3 tremor(double t) const noexcept;

  [[nodiscard]] const HandParams& params() const noexcept { return params_; }

 private:
  static constexpr std::size_t kSines = 8;
  HandParams params_;
  std::array<std::array<double, kSines>, 3> frequency_{};  // rad/s
  std::array<std::array<double, kSines>, 3> phase_{};      // rad
};

}  // namespace artus
