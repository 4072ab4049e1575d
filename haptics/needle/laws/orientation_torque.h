// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include "artus/detail/haptics/needle/laws/force_model.h"

namespace artus {

struct OrientationParams {
  double stiffness =
      0.5;  ///< N m/rad at full depth in tissue of 200 N/m; assumed: 200 N/m * (50 mm)^2
  double damping =
      2e-3;  ///< N m s/rad; assumed: well below what the velocity estimate's lag allows
  double reference_clamping = 200;  ///< N/m, the tissue's clamping that `stiffness` is stated for
};

/// The rotation vector (axis * angle, rad, frame J) that turns `current` into `reference` the short
/// way round. Source [Alamilla2020] eqs. 2.21-2.24 with atan2; for |q_r.w| < 0 the quaternion's
/// sign is turned so that angle and axis belong together.
[[nodiscard]] ARTUS_REALTIME Vec3 orientation_error(const Eigen::Quaterniond& current,
                                                    const Eigen::Quaterniond& reference) noexcept;

/// The tissue holds the needle's direction: tau = k eps - B omega (2.25). k grows with depth like
/// clamping. Rotation about the needle's own axis is free.
class OrientationTorque {
 public:
  explicit OrientationTorque(const OrientationParams& params = {}) noexcept : params_(params) {}
  ARTUS_REALTIME void reset(double depth) noexcept;
  ARTUS_REALTIME Wrench step(const NeedleTick& tick) noexcept;

 private:
  OrientationParams params_;
};

}  // namespace artus
