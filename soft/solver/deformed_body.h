// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <memory>
#include <vector>

#include "artus/anatomy/compiled_joint.h"
#include "artus/detail/soft/solver/soft_solver.h"

namespace artus {

/// Vertices of the interfaces that are carried together: neighbours, equally near to what is looked
/// at. Those that hang on the same points stand beside each other.
struct VertexGroup {
  std::vector<std::uint32_t> vertices;
  std::vector<Vec3> rest;             ///< (vertices) m, frame J, of the map's own shape
  std::vector<MapPlace> places;       ///< (vertices)
  std::vector<std::uint32_t> points;  ///< of the map, that move them, ascending
  double tolerance = 0;               ///< m that a point may move before the vertices do
};

struct BodyMap;

/// A joint and where its surfaces lie in a cage.
struct MappedJoint {
  std::shared_ptr<const CompiledJoint> joint;
  std::shared_ptr<const BodyMap> map;
};

/// What all snapshots of a body share: the model and where its surfaces lie in the cage.
struct BodyMap {
  Pose X_JC = Pose::Identity();
  std::shared_ptr<const SoftModel> model;
  std::vector<VertexGroup> groups;
  std::vector<std::uint32_t> group_of;  ///< (vertices of the interfaces); groups.size(): none moves
  /// Another shape of the same surfaces, whose groups these are: one index of them does for both.
  /// Null: they are this map's own.
  MappedJoint first;
};

/// The map of a joint in a cage at X_JC: all vertices of its interfaces found in their cubes.
[[nodiscard]] std::shared_ptr<const BodyMap> make_body_map(const CompiledJoint& joint,
                                                           const Pose& X_JC,
                                                           std::shared_ptr<const SoftModel> model);

/// What an index of its surfaces is of: itself, or the shape that it shares one with.
[[nodiscard]] MappedJoint indexed(const MappedJoint& mapped);

/// The map of another shape of a body in the cage of `others`, which must be one: in the groups of
/// the first of them that has the same surfaces between other vertices and whose vertices outside
/// the cage are where this one's are; otherwise in its own. Requires: at least one. Cost: finds the
/// vertices that moved, or all, in their cubes.
[[nodiscard]] std::shared_ptr<const BodyMap> make_body_map(const CompiledJoint& shape,
                                                           std::span<const MappedJoint> others);

/// One instant of a body that gives way: immutable, all of it from one state, so that picture,
/// force and score never see two. X is a material point (rest), x = X + u(X) where it is now; frame
/// J.
class DeformedBody {
 public:
  /// The vertices of a group are carried anew when a point of the map that moves them is farther
  /// than the group's tolerance from where it last did (`before`: an earlier state of the same map,
  /// or none): what indexes the surfaces then has less to do.
  DeformedBody(std::shared_ptr<const CompiledJoint> joint, std::shared_ptr<const BodyMap> map,
               std::span<const Vec3> node_displacements, const ContactForce& contact_J,
               const DeformedBody* before = nullptr);

  /// This body with its vertices `part` of the way from where those of `other` are, which has as
  /// many in a cage of the same model: of one shape that becomes another. Cost: some ms.
  [[nodiscard]] std::shared_ptr<const DeformedBody> come_from(const DeformedBody& other,
                                                              double part) const;

  [[nodiscard]] const CompiledJoint& joint() const noexcept { return *joint_; }
  [[nodiscard]] const std::shared_ptr<const CompiledJoint>& shared_joint() const noexcept {
    return joint_;
  }
  [[nodiscard]] const std::shared_ptr<const BodyMap>& shared_map() const noexcept { return map_; }

  /// A group's vertices where they were carried last, m, frame J, and the displacements of the
  /// group's points that did it, frame C. States share what did not go on.
  struct Moved {
    std::vector<Vec3> vertices;
    std::vector<Vec3> points;
  };
  /// Of each group of the map.
  [[nodiscard]] std::span<const std::shared_ptr<const Moved>> groups() const noexcept {
    return groups_;
  }
  /// Where the vertices of the interfaces are now, m: the first ones of TetMesh::vertices. Cost:
  /// gathers them from the groups.
  [[nodiscard]] std::vector<Vec3> vertices() const;

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
  /// The box around a point, frame C, m, in which the map is one polynomial: its cube or, where
  /// several tissues share that, a part of it between their borders. `whole` says which.
  struct Piece {
    Vec3 low = Vec3::Zero();
    Vec3 high = Vec3::Zero();
    bool whole = true;
  };
  [[nodiscard]] Piece piece_around(const Vec3& p_C, std::int32_t cell) const noexcept;
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
    return std::span(u_).first(map_->model->cage().nodes().size());
  }  ///< frame C
  [[nodiscard]] const BodyMap& map() const noexcept { return *map_; }
  [[nodiscard]] MappedJoint mapped() const noexcept { return {joint_, map_}; }

 private:
  std::shared_ptr<const CompiledJoint> joint_;
  std::shared_ptr<const BodyMap> map_;
  [[nodiscard]] Motion between_columns(const LayerMap::Around& four, double s_z,
                                       double edge) const noexcept;
  [[nodiscard]] Motion in_J(const Motion& motion) const noexcept;
  void carry(const DeformedBody* before);

  std::vector<Vec3> u_;  // (n_nodes, then the points of the map's columns) frame C
  Pose X_CJ_ = Pose::Identity();
  std::vector<std::shared_ptr<const Moved>> groups_;
  ContactForce contact_;
};

}  // namespace artus
