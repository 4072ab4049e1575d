// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>

namespace artus {

/// A point or vector; metres unless the name says otherwise.
using Vec3 = Eigen::Vector3d;

/// A rigid pose X_AB: maps coordinates in frame B to coordinates in frame A.
using Pose = Eigen::Isometry3d;

/// A straight piece of line from `start` to `end`, metres, frame J (the joint's) unless named.
struct Segment {
  Vec3 start = Vec3::Zero();
  Vec3 end = Vec3::Zero();
};

/// The pose whose z axis is along `z`, whose x axis is as near to `x_hint` as orthogonality
/// allows, and whose origin is `p`. Requires: `z` not zero; a parallel or zero hint is replaced by
/// a fixed deterministic one.
[[nodiscard]] Pose make_pose(const Vec3& p, const Vec3& z, const Vec3& x_hint);

/// The smallest rotation that turns the direction of `from` into that of `to`; of opposite ones,
/// about some axis square to them. Requires: neither is zero.
[[nodiscard]] Eigen::Quaterniond rotation_between(const Vec3& from, const Vec3& to) noexcept;

}  // namespace artus
