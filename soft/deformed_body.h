// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <memory>
#include <vector>

#include "artus/anatomy/body/compiled_joint.h"
#include "artus/soft/soft_solver.h"

namespace artus {

/// What all snapshots of a body share: the model and where its surfaces lie in the cage.
struct BodyMap {
  Pose X_JC = Pose::Identity();
  std::shared_ptr<const SoftModel> model;
  std::vector<std::uint32_t> moving;  ///< vertices of the joint's interfaces that lie in the cage
  std::vector<CagePlace> places;      ///< (moving)
};

/// One instant of a body that gives way: immutable, all of it from one state, so that picture,
/// force and score never see two. X is a material point (rest), x = X + u(X) where it is now; frame
/// J.
class DeformedBody {
 public:
  DeformedBody(std::shared_ptr<const CompiledJoint> joint, std::shared_ptr<const BodyMap> map,
               std::span<const Vec3> node_displacements, const ContactForce& contact_J);

  [[nodiscard]] const CompiledJoint& joint() const noexcept { return *joint_; }

  /// Where the vertices of the interfaces are now, m (n_interface_vertices): the first ones of
  /// TetMesh::vertices.
  [[nodiscard]] std::span<const Vec3> vertices() const noexcept { return vertices_; }

  /// The joint with all vertices where they are now: a body like any other, for a Scene of this
  /// instant. Fibre axes and landmarks stay as they were. Cost: a copy of the joint.
  [[nodiscard]] CompiledJoint moved_joint() const;

  /// u(X); zero outside the cage. Cost: about 50 ns.
  [[nodiscard]] Vec3 displacement(const Vec3& p_rest) const noexcept;

  /// X(x), by fixed-point steps that start at `p - guess`; with the displacement of the point
  /// found. Exact to 1e-7 m where the body is not folded.
  struct Rest {
    Vec3 p_rest = Vec3::Zero();
    Vec3 displacement = Vec3::Zero();
    bool found = false;  ///< false: no convergence; the best point is given
  };
  [[nodiscard]] Rest to_rest(const Vec3& p, const Vec3& guess = Vec3::Zero()) const noexcept;

  /// Rotation of the tissue at X: the polar part of the deformation gradient.
  [[nodiscard]] Eigen::Matrix3d rotation(const Vec3& p_rest) const noexcept;
  /// Deformation gradient F at X, frame J, of the cube around it.
  [[nodiscard]] Eigen::Matrix3d gradient(const Vec3& p_rest) const noexcept;

  [[nodiscard]] const ContactForce& contact() const noexcept { return contact_; }  ///< frame J
  [[nodiscard]] std::span<const Vec3> node_displacements() const noexcept {
    return u_;
  }  ///< frame C
  [[nodiscard]] const BodyMap& map() const noexcept { return *map_; }

 private:
  std::shared_ptr<const CompiledJoint> joint_;
  std::shared_ptr<const BodyMap> map_;
  std::vector<Vec3> u_;         // (n_nodes) frame C
  std::vector<Vec3> vertices_;  // frame J
  ContactForce contact_;
};

}  // namespace artus
