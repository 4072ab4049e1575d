// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include "artus/core/geometry.h"
#include "artus/detail/core/check.h"

namespace artus {

/// A pose as plain numbers that can be copied between threads and into files byte for byte:
/// position, then quaternion w, x, y, z.
struct PlainPose {
  double position[3] = {0, 0, 0};  // NOLINT(*-avoid-c-arrays): bytes of a file and of shared memory
  double rotation[4] = {1, 0, 0, 0};  // NOLINT(*-avoid-c-arrays)
};
[[nodiscard]] PlainPose to_plain(const Pose& pose) noexcept;
/// The rigid pose with the rotation normalised. Requires: finite, rotation not zero.
[[nodiscard]] Pose to_pose(const PlainPose& plain) noexcept;

/// m, farther than any device on a table.
inline constexpr double kDeviceReach = 10;
/// Finite, within `reach` of the origin, quaternion of norm 0.9 to 1.1: something a device can be.
[[nodiscard]] ARTUS_REALTIME bool is_pose(const PlainPose& plain,
                                          double reach = kDeviceReach) noexcept;

/// The pose a share of the motion from `a` to `b`: straight, and by the smallest turn.
[[nodiscard]] ARTUS_REALTIME PlainPose blend(const PlainPose& a, const PlainPose& b,
                                             double share) noexcept;
/// The rotation, normalised.
[[nodiscard]] ARTUS_REALTIME Eigen::Quaterniond rotation_of(const PlainPose& pose) noexcept;

}  // namespace artus
