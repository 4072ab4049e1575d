// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/core/geometry.h"

namespace artus {

// Eigen's way for opposite directions is a singular value decomposition, which takes a compiler ten
// seconds: here it is compiled once.
Eigen::Quaterniond rotation_between(const Vec3& from, const Vec3& to) noexcept {
  return Eigen::Quaterniond::FromTwoVectors(from, to);
}

}  // namespace artus
