// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <atomic>
#include <functional>
#include <vector>

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
  /// multiplied by a function of it keeps its volume. (n_nodes). Cost: some 10 ms.
  [[nodiscard]] std::vector<double> carry_on(
      const std::function<double(const Vec3& p_J)>& on_walls) const;

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
  std::vector<bool> on_wall_;         // by node
  std::vector<std::uint32_t> start_;  // (n_nodes + 1), of beside_
  struct Beside {
    std::uint32_t node;
    double weight;
  };
  std::vector<Beside> beside_;    // what a node is coupled to, itself among them
  std::vector<double> diagonal_;  // of that
};

}  // namespace artus
