// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include "artus/core/geometry.h"

namespace artus {

/// Where the joint is seen from.
struct OrbitCamera {
  static constexpr double kNearest = 0.03;  ///< m
  static constexpr double kFarthest = 2.2;  ///< m

  Vec3 centre = Vec3::Zero();  ///< m, frame J
  double yaw = 0;              ///< rad
  double pitch = 0;            ///< rad
  double distance = 0.2;       ///< m
  Vec3 up = Vec3::UnitZ();
  Vec3 side = Vec3::UnitX();
};

/// Where its eye is, frame J.
[[nodiscard]] Vec3 eye_of(const OrbitCamera& camera);

/// Of an eye that looks at `centre`, and of a picture whose height is seen under `height_angle`.
[[nodiscard]] Eigen::Matrix4f look_at(const Vec3& eye, const Vec3& centre, const Vec3& up);
[[nodiscard]] Eigen::Matrix4f perspective(double height_angle, double aspect, double near,
                                          double far);

}  // namespace artus
