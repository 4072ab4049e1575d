// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "artus/detail/soft/solver/soft_model.h"

namespace artus {

/// The body's surface near the probe: triangles whose right-hand normal points out of the body.
struct SkinPatch {
  std::vector<Vec3> vertices;  ///< m, rest, frame C
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// The probe's face: a flat rectangle in x-y of frame P, z into the body.
struct ProbeFace {
  double length = 0.040;  ///< m along x
  double width = 0.006;   ///< m along y
  int points_x = 16;
  int points_y = 3;
  bool round = false;       ///< an ellipse with these diameters, for punches of closed form
  double friction = 0.05;   ///< Coulomb coefficient; with gel; assumed: lubricated skin
  double gel_gap = 0.5e-3;  ///< m of gap that gel still couples; assumed
};

/// A piece of the face and the material point of the skin before it.
struct ContactPoint {
  std::uint32_t piece = 0;     ///< of the face, x fastest
  Vec3 p_rest = Vec3::Zero();  ///< m, frame C
  Vec3 lift = Vec3::Zero();    ///< m, frame C, of the skin there by what lies under it
  CagePlace place;
  std::vector<UnknownShare> shares;  ///< of the root's nodes, by their number there
  double gap = 0;                    ///< m along z of P at the displacement it was prepared for
  std::array<double, 2> start{};     ///< m, in P before the probe moved: what friction holds
};

/// A piece of the face that presses.
struct PressingPiece {
  Vec3 p = Vec3::Zero();  ///< m, its middle now, frame as ContactForce
  double force = 0;       ///< N along the face's z
};

/// Force between probe and body.
struct ContactForce {
  Vec3 force = Vec3::Zero();   ///< N on the probe, frame C
  Vec3 torque = Vec3::Zero();  ///< N m on the probe, about the face's centre, frame C
  double share = 0;            ///< of the face that presses, 0..1
  bool outside = false;        ///< a piece of the face met skin that the contact does not reach
  Vec3 into = Vec3::UnitZ();   ///< the face's z, frame C
  double piece_area = 0;       ///< m^2 of each piece
  std::vector<PressingPiece> pieces;  ///< that press
};

/// A face that presses, once the tissue has come to rest.
struct FacePress {
  ContactForce contact;
  double stiffness = 0;  ///< N/m along the face's z
};

/// Unilateral contact with friction of a flat face and the skin, in the compliance that the root of
/// the factor has: g = C lambda + g_free >= 0, lambda >= 0, tangential force at most friction times
/// lambda. Holds the forces per piece of the face from one step to the next; deterministic.
class FaceContact {
 public:
  /// `root`: unknowns in the root of the factor, ascending. Requires: a face with size and points.
  FaceContact(std::shared_ptr<const SoftModel> model, SkinPatch skin, const ProbeFace& face,
              std::span<const std::uint32_t> root);

  /// How far each vertex of the skin is lifted by what was put under it, m, frame C; empty:
  /// nowhere.
  void set_lifts(std::vector<Vec3> lifts);

  /// Finds the material point before each piece of the face at `X_CP` under displacements `u`;
  /// `X_CP_before`: where the face was, so that friction knows how far it slid.
  void prepare(std::span<const Vec3> u, const Pose& X_CP, const Pose& X_CP_before);

  /// Compliance of the points from the root's inverse (root_nodes of Cholesky, all unknowns'
  /// order).
  void condense(const Eigen::MatrixXf& root_inverse);

  /// Adds the present forces to the right side (3 n_unknowns).
  void add_forces(Eigen::VectorXd& on_unknowns) const;

  /// Changes the forces so that the face is not passed when the points, moved by `step_root` (3
  /// n_root) without the change, move on by alpha * C * change. Adds the change to `load_root`.
  void solve(const Eigen::VectorXd& step_root, std::span<const Vec3> u, double alpha,
             Eigen::VectorXd& load_root);

  [[nodiscard]] ContactForce force() const;

  /// Finds the forces with which the face would press at rest, where the points moved by
  /// `step_root` go the whole displacement: what relaxes is not in them. Changes neither forces nor
  /// points.
  void settle(const Eigen::VectorXd& step_root, std::span<const Vec3> u);
  /// The same as force(), of those at rest.
  [[nodiscard]] ContactForce force_at_rest() const { return sum(at_rest_); }

  /// How much less force for a motion along the face's z, N/m: through the pieces that press at
  /// rest. Not negative.
  [[nodiscard]] double stiffness_at_rest() const;
  [[nodiscard]] std::span<const ContactPoint> points() const noexcept { return points_; }
  [[nodiscard]] double pressure_at(std::uint32_t piece) const noexcept;          ///< Pa
  [[nodiscard]] std::span<const double> gaps() const noexcept { return gaps_; }  ///< m by piece
  void release() noexcept;  ///< forgets all forces

 private:
  [[nodiscard]] ContactForce sum(std::span<const Vec3> forces) const;
  [[nodiscard]] Eigen::VectorXd forces_of(const std::vector<Vec3>& by_piece) const;
  void balance(const Eigen::VectorXd& step_root, std::span<const Vec3> u, double alpha,
               Eigen::VectorXd& force) const;
  [[nodiscard]] std::vector<ContactPoint> cast(std::span<const Vec3> u) const;
  void raster(std::size_t triangle, const std::vector<Vec3>& skin_P,
              std::vector<ContactPoint>& nearest) const;
  [[nodiscard]] Vec3 piece_P(std::uint32_t piece) const noexcept;

  std::shared_ptr<const SoftModel> model_;
  SkinPatch skin_;
  std::vector<CagePlace> skin_places_;
  std::vector<Vec3> lifts_;  // (skin vertices) or empty
  ProbeFace face_;
  std::vector<std::int32_t> root_of_unknown_;
  Pose X_CP_ = Pose::Identity();
  std::vector<ContactPoint> points_;
  std::vector<Vec3> forces_;    // N on the tissue by piece: tangential x, y, normal z of P
  std::vector<Vec3> at_rest_;   // the same as they would be at rest
  std::vector<double> gaps_;    // m by piece; infinite where there is no skin
  Eigen::MatrixXd compliance_;  // (3 n_points, 3 n_points), axes of P
  bool outside_ = false;
};

}  // namespace artus
