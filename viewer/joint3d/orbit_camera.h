// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include "artus/core/geometry.h"

namespace artus {

/// Where the joint is seen from.
struct OrbitCamera {
  Vec3 centre = Vec3::Zero();  ///< m, frame J
  double yaw = 0;              ///< rad
  double pitch = 0;            ///< rad
  double distance = 0.2;       ///< m
  Vec3 up = Vec3::UnitZ();
  Vec3 side = Vec3::UnitX();
};

}  // namespace artus
