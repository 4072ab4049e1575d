// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include "artus/core/geometry.h"

namespace artus {

/// Whether numbers that came from outside are a pose: every number finite, the rotation orthonormal
/// within 1e-6 and without a mirror. Errors: none. Cost: some ns.
[[nodiscard]] inline bool is_rigid(const Pose& pose) noexcept {
  constexpr double kTolerance = 1e-6;  // on R^T R - 1
  if (!pose.matrix().allFinite()) return false;
  const Eigen::Matrix3d r = pose.linear();
  return (r.transpose() * r - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() < kTolerance &&
         r.determinant() > 0;
}

}  // namespace artus
