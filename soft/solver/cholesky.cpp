// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/soft/solver/cholesky.h"

#include <algorithm>
#include <cmath>

#include "artus/detail/soft/cage/kernels.h"

namespace artus {
namespace {

using Index = Eigen::Index;

Index dofs(const std::vector<std::uint32_t>& nodes) noexcept {
  return static_cast<Index>(3 * nodes.size());
}

void gather(const std::vector<std::uint32_t>& nodes, const Eigen::VectorXd& x, float* part) {
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    const double* from = x.data() + 3 * static_cast<std::size_t>(nodes[k]);
    for (std::size_t c = 0; c < 3; ++c) part[3 * k + c] = static_cast<float>(from[c]);
  }
}

void scatter(const std::vector<std::uint32_t>& nodes, const float* part, Eigen::VectorXd& x) {
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    double* to = x.data() + 3 * static_cast<std::size_t>(nodes[k]);
    for (std::size_t c = 0; c < 3; ++c) to[c] = static_cast<double>(part[3 * k + c]);
  }
}

void scatter_add(const std::vector<std::uint32_t>& nodes, const float* part, Eigen::VectorXd& x) {
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    double* to = x.data() + 3 * static_cast<std::size_t>(nodes[k]);
    for (std::size_t c = 0; c < 3; ++c) to[c] += static_cast<double>(part[3 * k + c]);
  }
}

}  // namespace

BlockMatrix::BlockMatrix(const NodeGraph& of)
    : graph(&of),
      diagonal(of.size(), Eigen::Matrix3d::Zero()),
      upper(of.neighbours.size(), Eigen::Matrix3d::Zero()) {}

void BlockMatrix::add(std::uint32_t i, std::uint32_t j, const Eigen::Matrix3d& block) noexcept {
  if (i == j) {
    diagonal[i] += block;
    return;
  }
  if (i > j) return;
  const auto near = graph->of(i);
  const auto at = std::lower_bound(near.begin(), near.end(), j) - near.begin();
  upper[graph->start[i] + static_cast<std::size_t>(at)] += block;
}

void BlockMatrix::set_zero() noexcept {
  std::fill(diagonal.begin(), diagonal.end(), Eigen::Matrix3d::Zero());
  std::fill(upper.begin(), upper.end(), Eigen::Matrix3d::Zero());
}

Cholesky::Cholesky(Dissection plan) : plan_(std::move(plan)) {
  place_in_parent_.resize(plan_.fronts.size());
  fronts_.resize(plan_.fronts.size());
  std::vector<std::uint32_t> place(plan_.position.size(), 0);
  for (const FrontPlan& front : plan_.fronts) {
    std::uint32_t next = 0;
    for (const std::uint32_t n : front.own) place[n] = next++;
    for (const std::uint32_t n : front.boundary) place[n] = next++;
    for (const std::uint32_t child : front.children) {
      for (const std::uint32_t n : plan_.fronts[child].boundary)
        place_in_parent_[child].push_back(place[n]);
    }
  }
}

/// The front's dense matrix (lower triangle): its nodes' entries and what its children left. Below
/// the root's own stands the identity, so that its elimination leaves minus its inverse.
Eigen::MatrixXd Cholesky::assemble(std::size_t f, const BlockMatrix& matrix,
                                   std::vector<Eigen::MatrixXd>& eliminated) const {
  const FrontPlan& front = plan_.fronts[f];
  const Index n_own = dofs(front.own);
  const bool root = f + 1 == plan_.fronts.size();
  const Index n = n_own + (root ? n_own : dofs(front.boundary));
  Eigen::MatrixXd F = Eigen::MatrixXd::Zero(n, n);
  std::vector<std::pair<std::uint32_t, Index>> place;  // node, row
  for (Index k = 0; k < static_cast<Index>(front.own.size()); ++k)
    place.emplace_back(front.own[static_cast<std::size_t>(k)], 3 * k);
  for (Index k = 0; k < static_cast<Index>(front.boundary.size()); ++k)
    place.emplace_back(front.boundary[static_cast<std::size_t>(k)], n_own + 3 * k);
  std::sort(place.begin(), place.end());
  for (std::size_t k = 0; k < front.own.size(); ++k) {
    const std::uint32_t i = front.own[k];
    const Index column = 3 * static_cast<Index>(k);
    F.block<3, 3>(column, column) += matrix.diagonal[i];
    for (const std::uint32_t j : matrix.graph->of(i)) {
      if (plan_.position[j] < plan_.position[i]) continue;
      const auto at = std::lower_bound(place.begin(), place.end(), std::pair(j, Index{0}));
      const std::uint32_t low = std::min(i, j);
      const auto near = matrix.graph->of(low);
      const auto entry =
          matrix.graph->start[low] +
          static_cast<std::size_t>(std::lower_bound(near.begin(), near.end(), std::max(i, j)) -
                                   near.begin());
      // The stored block is (low, high); the one below the diagonal has row j and column i.
      if (low == j) {
        F.block<3, 3>(at->second, column) += matrix.upper[entry];
      } else {
        F.block<3, 3>(at->second, column) += matrix.upper[entry].transpose();
      }
    }
  }
  for (const std::uint32_t child : front.children) {
    const Index left = dofs(plan_.fronts[child].boundary);
    const auto rest = eliminated[child].bottomRightCorner(left, left);
    const auto& to = place_in_parent_[child];
    for (std::size_t c = 0; c < to.size(); ++c) {
      for (std::size_t r = c; r < to.size(); ++r) {
        const auto row = 3 * static_cast<Index>(r);
        const auto column = 3 * static_cast<Index>(c);
        F.block<3, 3>(3 * static_cast<Index>(to[r]), 3 * static_cast<Index>(to[c])) +=
            rest.block<3, 3>(row, column);
      }
    }
    eliminated[child].resize(0, 0);
  }
  if (root) F.bottomLeftCorner(n_own, n_own).setIdentity();
  return F;
}

bool Cholesky::factorize(const BlockMatrix& matrix) {
  const SoftKernels& kernels = soft_kernels();
  std::vector<Eigen::MatrixXd> eliminated(plan_.fronts.size());
  std::vector<double> scratch;
  smallest_pivot_ = std::numeric_limits<double>::infinity();
  for (std::size_t f = 0; f < plan_.fronts.size(); ++f) {
    const Index n_own = dofs(plan_.fronts[f].own);
    Eigen::MatrixXd F = assemble(f, matrix, eliminated);
    const auto n = static_cast<std::size_t>(F.rows());
    scratch.resize(std::max(scratch.size(), elimination_scratch(n)));
    if (!kernels.eliminate(F.data(), n, static_cast<std::size_t>(n_own), scratch.data()))
      return false;
    if (n_own > 0) {
      const auto pivots = F.diagonal().head(n_own);
      if (!std::isfinite(pivots.sum())) return false;
      smallest_pivot_ = std::min(smallest_pivot_, std::pow(pivots.minCoeff(), 2));
    }
    if (f + 1 < plan_.fronts.size()) {
      fronts_[f] = F.leftCols(n_own).cast<float>();
      eliminated[f] = std::move(F);
    } else {
      root_ = F.topLeftCorner(n_own, n_own);
      root_inverse_ = -F.bottomRightCorner(n_own, n_own);
      root_inverse_.triangularView<Eigen::StrictlyUpper>() = root_inverse_.transpose();
    }
  }
  return true;
}

void Cholesky::forward(Eigen::VectorXd& x) const {
  const SoftKernels& kernels = soft_kernels();
  std::vector<float> part;
  for (std::size_t f = 0; f + 1 < fronts_.size(); ++f) {
    const FrontPlan& front = plan_.fronts[f];
    if (front.own.empty()) continue;
    const auto rows = static_cast<std::size_t>(fronts_[f].rows());
    part.assign(rows, 0.0F);
    gather(front.own, x, part.data());
    kernels.forward(fronts_[f].data(), rows, 3 * front.own.size(), part.data());
    scatter(front.own, part.data(), x);
    scatter_add(front.boundary, part.data() + 3 * front.own.size(), x);
  }
}

void Cholesky::solve_root(Eigen::VectorXd& x) const {
  const auto& nodes = plan_.fronts.back().own;
  if (nodes.empty()) return;
  Eigen::VectorXd own(dofs(nodes));
  for (std::size_t k = 0; k < nodes.size(); ++k)
    own.segment<3>(3 * static_cast<Index>(k)) = x.segment<3>(3 * static_cast<Index>(nodes[k]));
  const auto L = root_.triangularView<Eigen::Lower>();
  L.solveInPlace(own);
  L.transpose().solveInPlace(own);
  for (std::size_t k = 0; k < nodes.size(); ++k)
    x.segment<3>(3 * static_cast<Index>(nodes[k])) = own.segment<3>(3 * static_cast<Index>(k));
}

void Cholesky::backward(Eigen::VectorXd& x) const {
  const SoftKernels& kernels = soft_kernels();
  std::vector<float> part;
  for (std::size_t f = fronts_.size() - 1; f-- > 0;) {
    const FrontPlan& front = plan_.fronts[f];
    if (front.own.empty()) continue;
    part.resize(static_cast<std::size_t>(fronts_[f].rows()));
    gather(front.own, x, part.data());
    gather(front.boundary, x, part.data() + 3 * front.own.size());
    kernels.backward(fronts_[f].data(), part.size(), 3 * front.own.size(), part.data());
    scatter(front.own, part.data(), x);
  }
}

void Cholesky::solve(Eigen::VectorXd& x) const {
  forward(x);
  solve_root(x);
  backward(x);
}

std::size_t Cholesky::entries() const noexcept {
  std::size_t n = 0;
  for (const Eigen::MatrixXf& front : fronts_) {
    const Index own = front.cols();
    n += static_cast<std::size_t>(front.rows() * own - own * (own - 1) / 2);
  }
  return n;
}

}  // namespace artus
