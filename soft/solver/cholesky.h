// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "artus/detail/soft/solver/dissection.h"

namespace artus {

/// A symmetric matrix of 3 x 3 blocks: the diagonal block of each node and, for i < j, block (i, j)
/// of each pair of neighbours.
struct BlockMatrix {
  explicit BlockMatrix(const NodeGraph& graph);
  /// Adds to block (i, j); the caller gives each pair in both orders or in one: those with i > j
  /// are left out. Requires: neighbours, or i == j.
  void add(std::uint32_t i, std::uint32_t j, const Eigen::Matrix3d& block) noexcept;
  void set_zero() noexcept;

  const NodeGraph* graph = nullptr;
  std::vector<Eigen::Matrix3d> diagonal;  ///< (n_nodes)
  std::vector<Eigen::Matrix3d> upper;     ///< (n_neighbours), used where the neighbour is later
};

/// Sparse Cholesky factor, multifrontal: dense pieces along a dissection, in one thread and without
/// a BLAS, so that the bytes depend on nothing but the numbers. Source [Duff1983].
class Cholesky {
 public:
  explicit Cholesky(Dissection plan);

  /// False when the matrix is not positive definite; the factor is then useless.
  [[nodiscard]] bool factorize(const BlockMatrix& matrix);

  /// Unknowns (3 n_nodes) in the nodes' own order. `solve` is `forward`, `solve_root`, `backward`;
  /// between them x holds the root's right side, where loads on the root's nodes may be added.
  void solve(Eigen::VectorXd& x) const;
  void forward(Eigen::VectorXd& x) const;
  void solve_root(Eigen::VectorXd& x) const;
  void backward(Eigen::VectorXd& x) const;

  [[nodiscard]] std::span<const std::uint32_t> root_nodes() const noexcept {
    return plan_.fronts.back().own;
  }
  /// Inverse of what elimination leaves of the matrix on the root's nodes: their compliance, m/N,
  /// with all others free. Rows as root_nodes().
  [[nodiscard]] const Eigen::MatrixXd& root_inverse() const noexcept { return root_inverse_; }

  [[nodiscard]] std::size_t entries() const noexcept;  ///< of the factor
  [[nodiscard]] double smallest_pivot() const noexcept { return smallest_pivot_; }

 private:
  [[nodiscard]] Eigen::MatrixXd assemble(std::size_t f, const BlockMatrix& matrix,
                                         std::vector<Eigen::MatrixXd>& eliminated) const;

  Dissection plan_;
  std::vector<std::vector<std::uint32_t>> place_in_parent_;  // of each front's boundary nodes
  std::vector<Eigen::MatrixXf>
      fronts_;            // (own + boundary, own) each: lower triangle of L, then L21
  Eigen::MatrixXd root_;  // L of the root
  Eigen::MatrixXd root_inverse_;
  double smallest_pivot_ = 0;
};

}  // namespace artus
