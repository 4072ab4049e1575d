// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <atomic>
#include <functional>
#include <memory>
#include <vector>

#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCore>

#include "artus/detail/soft/liquid/sided_cage.h"

namespace artus {

/// How tissue around a space gives way to its liquid, to first order: linear elasticity on a cage,
/// a pressure on all of the space's walls, bone and the box's border held, skin free. Walls that
/// lie on each other stick near a rim. Immutable.
class OpeningField {
 public:
  /// `stop`: gives up as soon as it says so, with a field of nothing; null: never. Cost: one to
  /// three seconds of one thread and some 100 MB meanwhile.
  OpeningField(const CompiledJoint& joint, const SidedCage& cage,
               const std::atomic<bool>* stop = nullptr);

  /// m/Pa by which the nodes move. (n_nodes).
  [[nodiscard]] const std::vector<Vec3>& motion() const noexcept { return motion_; }

  /// What is told on the walls, carried on into tissue so that it has no steps: Laplace's equation,
  /// nothing through the border, ten times as easily the way that tissue moves, so that what is
  /// multiplied by a function of it keeps its volume. `exactness`: of the first error, what may be
  /// left. (n_nodes). Cost: some 50 ms.
  [[nodiscard]] std::vector<double> carry_on(const std::function<double(const Vec3& p_J)>& on_walls,
                                             double exactness) const;
  /// m^2, the same of the square of the walls' distance from a point. (n_nodes). Cost: one pass.
  [[nodiscard]] std::vector<double> squared_distance(const Vec3& from_J) const;

 private:
  void find_held(const CompiledJoint& joint);
  void find_stiffness(const CompiledJoint& joint);
  void spread(std::vector<bool>& nodes) const;
  void hold_islands();
  [[nodiscard]] Eigen::VectorXd anchors() const;
  void stick();
  void load();
  void solve(const std::atomic<bool>* stop);
  void join_nodes();
  void carry_distances();
  [[nodiscard]] Eigen::VectorXd carried(const Eigen::VectorXd& walls, double exactness) const;
  [[nodiscard]] Vec3 middle() const;
  [[nodiscard]] std::array<double, 6> conduction_of(const SidedCage::Copy& copy) const;
  [[nodiscard]] std::vector<double> times(const std::vector<double>& x) const;

  const SidedCage* cage_;
  struct Film {
    std::array<std::uint32_t, 16> nodes{};
    std::array<double, 16> share{};  // of the nodes' motion: one side less the other
    double stiffness = 0;            // N/m
  };
  std::vector<Film> films_;
  std::vector<std::uint32_t> giving_;  // copies that do not stand whole
  std::vector<double> modulus_;        // Pa m by copy, of its share of a cube
  std::vector<bool> held_;             // by node
  std::vector<double> force_;          // (n_nodes, 3), m^2
  std::vector<Vec3> motion_;
  std::vector<bool> on_wall_;  // by node
  using Matrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;
  Matrix inner_;  // (n_nodes, n_nodes), of what spreads; walls: themselves
  Matrix outer_;  // the same, what walls give to others
  using Preconditioner = Eigen::IncompleteCholesky<double>;
  std::shared_ptr<const Preconditioner> nearly_;  // of inner_
  // x, y, z, m, and the square of all three, m^2, from the cage's middle, carried on by node
  std::array<std::vector<double>, 4> carried_;
};

}  // namespace artus
