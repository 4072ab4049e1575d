// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "artus/core/geometry.h"

namespace artus {

/// How coordinates of a file become those of a joint: x_J = scale * turn * x.
struct AtlasFrame {
  double scale = 1;
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();  ///< axes change places and signs

  [[nodiscard]] Vec3 apply(const Vec3& p) const { return scale * (turn * p); }
  [[nodiscard]] Eigen::AlignedBox3d apply(const Eigen::AlignedBox3d& box) const;
  [[nodiscard]] bool is_identity() const { return scale == 1 && turn.isIdentity(0); }
  /// "times 1000, x y z from -x, z, y".
  [[nodiscard]] std::string to_string() const;
};

/// A box that is known, and the same structure's in a file.
struct KnownBox {
  Eigen::AlignedBox3d known;  ///< m
  Eigen::AlignedBox3d found;  ///< m as the file was read
  double near = 4e-3;         ///< m that a corner may lie from where it is known
};

/// m from the corners of `frame.apply(found)` to those of `known`: the farthest of any.
[[nodiscard]] double corners_apart(const AtlasFrame& frame, const KnownBox& box);

/// The frame in which most of the boxes lie where they are known, the plainest of those that do so
/// alike: unit (mm, cm, m, inch, and what a model was scaled by in a game engine) and axes (24
/// turns). nullopt: none of the boxes fits in any frame. Cost: 216 frames a box.
[[nodiscard]] std::optional<AtlasFrame> find_atlas_frame(const std::vector<KnownBox>& boxes);

}  // namespace artus
