// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "artus/anatomy/compiled_joint.h"
#include "artus/detail/soft/solver/deformed_body.h"
#include "artus/raycast/scene.h"

namespace artus {

/// The tetrahedron that is left with the least share of its volume.
struct LeastRatio {
  double ratio = 1;         ///< of its volume now to that at rest; 0 or less: inverted
  Vec3 p_J = Vec3::Zero();  ///< m, its middle at rest
  RegionId region = kOutside;
  std::vector<std::size_t> inverted;  ///< which are
  std::size_t compared = 0;           ///< 0: the bodies have not the same tetrahedra
};

/// Compares a mesh with the same at rest. Slivers are left out: a smooth map of the body may turn
/// one over. So is what is in regions of `liquid` (by RegionId, or empty): it has no shape of its
/// own. Cost: linear.
[[nodiscard]] LeastRatio find_least_ratio(const TetMesh& rest, const TetMesh& now,
                                          const std::vector<bool>& liquid = {});

/// Whether the tissue of a tetrahedron of body.joint() that is inverted is so itself: in that joint
/// already, or by the motion where the tetrahedron lies. Where cubes are smaller than a tetrahedron
/// its corners may change sides though nothing between them folds. Cost: 1 us.
[[nodiscard]] bool is_tissue_inverted(const DeformedBody& body, std::size_t tetrahedron);

/// How many points have a coordinate that is not finite.
[[nodiscard]] std::size_t count_not_finite(std::span<const Vec3> points);

/// The joint with its vertices where they are in this scene. Cost: a copy of the joint.
[[nodiscard]] CompiledJoint body_in(const Scene& scene);

/// By region of the joint: whether its name is one of `names`.
[[nodiscard]] std::vector<bool> regions_named(const CompiledJoint& joint,
                                              std::span<const std::string> names);

/// Parallel rays through a box: along z of X_JG from the middle of the box's first face.
struct RayGrid {
  Pose X_JG = Pose::Identity();
  double half_x = 0;   ///< m
  double half_y = 0;   ///< m
  double length = 0;   ///< m of a ray
  double spacing = 1;  ///< m between rays
};

/// A grid of at most about `rays` rays around points, no finer than 0.2 mm, along z of `axes`.
/// Requires: a point.
[[nodiscard]] RayGrid grid_around(std::span<const Vec3> points, const Eigen::Matrix3d& axes,
                                  std::size_t rays);

/// Vertices of the interfaces of these regions.
[[nodiscard]] std::vector<Vec3> points_of(const CompiledJoint& joint,
                                          const std::vector<bool>& regions);

/// m^3 of these regions that the rays meet. Cost: a query a ray.
[[nodiscard]] double volume_along(const Scene& scene, const RayGrid& grid,
                                  const std::vector<bool>& regions);

/// What became of the skin.
struct SkinLift {
  double lifted = 0;        ///< m^3 between the skin as it was and where it is higher
  double net = 0;           ///< m^3, less where it is lower
  double highest = 0;       ///< m
  Vec3 p_J = Vec3::Zero();  ///< m, where that is, before
};

/// Compares a joint's skin with itself before. Of bodies whose skin has other triangles `lifted` is
/// `net`, of the body's volume about `centre` (m), and nothing is told of where. Cost: linear in
/// interfaces.
[[nodiscard]] SkinLift find_skin_lift(const TetMesh& before, const TetMesh& after,
                                      const Vec3& centre);

}  // namespace artus
