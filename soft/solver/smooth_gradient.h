// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <vector>

#include "artus/detail/soft/solver/deformed_body.h"

namespace artus {

/// How tissue is turned and stretched, without the steps that the gradient of a displacement by
/// cubes has at their faces (a tenth and more, so that the normals of surfaces and the courses of
/// fibres would jump there by some degrees): at each node the mean of the cubes around it, between
/// them as the displacement. Layers that share a cube are turned as it is. Source: recovery at
/// nodes, [ZienkiewiczZhu1992]; here by the plain mean. Keeps a share of the body.
class SmoothGradient {
 public:
  /// Cost: about 0.1 us a cube.
  explicit SmoothGradient(std::shared_ptr<const DeformedBody> body);

  [[nodiscard]] const DeformedBody& body() const noexcept { return *body_; }

  /// F = dx/dX at a material point of a cube (m, in the cage's frame; -1: outside all, where it is
  /// the identity), frame J. Cost: 20 ns.
  [[nodiscard]] Eigen::Matrix3d at(const Vec3& rest_C, std::int32_t cell) const noexcept;

 private:
  using Entries = Eigen::Array<float, 12, 1>;  // columns of F, three that fill up

  std::shared_ptr<const DeformedBody> body_;
  std::vector<Entries> nodes_;  // (n_nodes) frame J
};

/// Where a surface faces whose normal was `rest_J` in a tissue of gradient F, not of unit length.
[[nodiscard]] inline Vec3 carried_normal(const Eigen::Matrix3d& F, const Vec3& rest_J) noexcept {
  return rest_J.x() * F.col(1).cross(F.col(2)) + rest_J.y() * F.col(2).cross(F.col(0)) +
         rest_J.z() * F.col(0).cross(F.col(1));
}

}  // namespace artus
