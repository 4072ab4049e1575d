// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include "artus/core/geometry.h"

namespace artus {

/// A force and a torque on the hand, at the needle tip, frame J.
struct Wrench {
  Vec3 force = Vec3::Zero();   ///< N
  Vec3 torque = Vec3::Zero();  ///< N m

  Wrench& operator+=(const Wrench& other) noexcept {
    force += other.force;
    torque += other.torque;
    return *this;
  }
};

}  // namespace artus
