// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <memory>
#include <vector>

#include "artus/anatomy/body/compiled_joint.h"
#include "artus/soft/soft_solver.h"

namespace artus {

/// The vertices of one cube: [begin, end) of BodyMap::moving.
struct CubeVertices {
  std::uint32_t cell = 0;
  std::uint32_t begin = 0;
  std::uint32_t end = 0;
};

/// What all snapshots of a body share: the model and where its surfaces lie in the cage.
struct BodyMap {
  Pose X_JC = Pose::Identity();
  std::shared_ptr<const SoftModel> model;
  /// Vertices of the joint's interfaces that lie in the cage; the first `n_near` in its finer cubes
  /// near the probe, cube by cube; last those in no cube, which do not move.
  std::vector<std::uint32_t> moving;
  std::vector<Vec3> shares;         ///< (moving) of the cube's edges, from its lowest corner
  std::vector<CubeVertices> cubes;  ///< as `moving` has them
  std::size_t n_near = 0;
  std::size_t n_near_cubes = 0;
  std::size_t n_vertices = 0;            ///< of the joint's interfaces
  std::vector<std::uint32_t> far_nodes;  ///< of the cubes that hold the others
};

/// The map of a joint in a cage at X_JC: all vertices of its interfaces found in their cubes.
[[nodiscard]] std::shared_ptr<const BodyMap> make_body_map(const CompiledJoint& joint,
                                                           const Pose& X_JC,
                                                           std::shared_ptr<const SoftModel> model);

/// One instant of a body that gives way: immutable, all of it from one state, so that picture,
/// force and score never see two. X is a material point (rest), x = X + u(X) where it is now; frame
/// J.
class DeformedBody {
 public:
  /// A node of the coarsest cubes moves far vertices only when it is 20 um from where it last did
  /// (`before`: an earlier state of the same map, or none): what indexes the surfaces then has less
  /// to do. The others are where u says.
  DeformedBody(std::shared_ptr<const CompiledJoint> joint, std::shared_ptr<const BodyMap> map,
               std::span<const Vec3> node_displacements, const ContactForce& contact_J,
               const DeformedBody* before = nullptr);

  [[nodiscard]] const CompiledJoint& joint() const noexcept { return *joint_; }
  [[nodiscard]] const std::shared_ptr<const CompiledJoint>& shared_joint() const noexcept {
    return joint_;
  }
  [[nodiscard]] const std::shared_ptr<const BodyMap>& shared_map() const noexcept { return map_; }

  /// Where the vertices of the interfaces are now, m (n_interface_vertices): the first ones of
  /// TetMesh::vertices.
  [[nodiscard]] std::span<const Vec3> vertices() const noexcept { return vertices_; }

  /// The joint with all vertices where they are now: a body like any other, for a Scene of this
  /// instant. Fibre axes and landmarks stay as they were. Cost: a copy of the joint.
  [[nodiscard]] CompiledJoint moved_joint() const;

  /// u(X) and F = dx/dX of one point, frame J.
  struct Motion {
    Vec3 displacement = Vec3::Zero();
    Eigen::Matrix3d gradient = Eigen::Matrix3d::Identity();
  };
  /// Zero and the identity outside the cage. Cost: below 0.1 us.
  [[nodiscard]] Motion motion(const Vec3& p_rest) const noexcept;
  [[nodiscard]] Vec3 displacement(const Vec3& p_rest) const noexcept;

  /// The same in the cage's frame, with the cube it comes from (-1: outside). Cost: as motion.
  struct PlacedMotion {
    Motion motion;
    std::int32_t cell = -1;
  };
  [[nodiscard]] PlacedMotion motion_in_cage(const Vec3& p_C) const noexcept;
  /// From frame J to the cage's.
  [[nodiscard]] const Pose& to_cage() const noexcept { return X_CJ_; }

  /// X(x), by Newton steps that start at `p - guess`; with the motion of the point found. Exact to
  /// 1e-7 m where the body is not folded, beside a cube's face to 1e-5 m. Cost: 0.1 us a step, one
  /// with a good guess.
  struct Rest {
    Vec3 p_rest = Vec3::Zero();
    Motion motion;
    bool found = false;  ///< false: no convergence; the best point is given
  };
  [[nodiscard]] Rest to_rest(const Vec3& p, const Vec3& guess = Vec3::Zero()) const noexcept;

  /// Rotation of the tissue at X: the polar part of the deformation gradient.
  [[nodiscard]] Eigen::Matrix3d rotation(const Vec3& p_rest) const noexcept;
  /// Deformation gradient F at X, frame J, in the middle of the cube around it.
  [[nodiscard]] Eigen::Matrix3d gradient(const Vec3& p_rest) const noexcept;

  [[nodiscard]] const ContactForce& contact() const noexcept { return contact_; }  ///< frame J
  [[nodiscard]] std::span<const Vec3> node_displacements() const noexcept {
    return u_;
  }  ///< frame C
  [[nodiscard]] const BodyMap& map() const noexcept { return *map_; }

 private:
  std::shared_ptr<const CompiledJoint> joint_;
  std::shared_ptr<const BodyMap> map_;
  [[nodiscard]] Motion in_J(const Motion& motion) const noexcept;
  void move_cube(const CubeVertices& cube, std::span<const Vec3> u);
  void move_far(const DeformedBody* before);

  std::vector<Vec3> u_;      // (n_nodes) frame C
  std::vector<Vec3> far_u_;  // (far_nodes) the same where a node moved its far vertices last
  Pose X_CJ_ = Pose::Identity();
  std::vector<Vec3> vertices_;  // frame J
  ContactForce contact_;
};

}  // namespace artus
