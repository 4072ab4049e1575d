// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/soft/solver/cholesky.h"

#include <gtest/gtest.h>

#include "artus/detail/core/noise.h"
#include "artus/detail/soft/solver/soft_block.h"

namespace artus {
namespace {

SoftBlock plain_block() {
  SoftBlock block;
  block.half_x = block.half_y = 12e-3;
  block.layers = {{12e-3, linear_material(3e3, 0.47)}};
  return block;
}

Eigen::MatrixXd dense_of(const BlockMatrix& m) {
  const auto n = static_cast<Eigen::Index>(3 * m.graph->size());
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(n, n);
  for (std::uint32_t i = 0; i < m.graph->size(); ++i) {
    A.block<3, 3>(3 * i, 3 * i) = m.diagonal[i];
    for (std::uint32_t e = m.graph->start[i]; e < m.graph->start[i + 1]; ++e) {
      const std::uint32_t j = m.graph->neighbours[e];
      if (j < i) continue;
      A.block<3, 3>(3 * i, 3 * j) = m.upper[e];
      A.block<3, 3>(3 * j, 3 * i) = m.upper[e].transpose();
    }
  }
  return A;
}

struct Fixture {
  std::shared_ptr<const SoftModel> model = make_block_model(
      plain_block(), 6e-3, {{Vec3(-4e-3, -4e-3, 0), Vec3(4e-3, 4e-3, 2e-3), 3e-3}});
  BlockMatrix K{model->graph()};
  Fixture() {
    const std::vector<Vec3> rest(model->cage().nodes().size(), Vec3::Zero());
    model->assemble_tangent(rest, {}, K);
  }
};

TEST(Cholesky, SolvesWhatADenseFactorSolves) {
  const Fixture f;
  const std::vector<std::uint32_t> root{3, 7, 8, 20};
  Cholesky cholesky(dissect(f.model->graph(), f.model->unknown_places(), root));
  ASSERT_TRUE(cholesky.factorize(f.K));
  const Eigen::MatrixXd A = dense_of(f.K);
  Eigen::VectorXd b(A.rows());
  for (Eigen::Index i = 0; i < b.size(); ++i)
    b[i] = uniform_noise(1, static_cast<unsigned>(i)) - 0.5;
  Eigen::VectorXd x = b;
  cholesky.solve(x);
  const Eigen::VectorXd exact = A.ldlt().solve(b);
  EXPECT_LT((x - exact).norm(), 1e-5 * exact.norm());
}

TEST(Cholesky, RootInverseIsTheComplianceOfTheRootsNodes) {
  const Fixture f;
  const std::vector<std::uint32_t> root{3, 7, 8, 20};
  Cholesky cholesky(dissect(f.model->graph(), f.model->unknown_places(), root));
  ASSERT_TRUE(cholesky.factorize(f.K));
  const Eigen::MatrixXd C = cholesky.root_inverse();
  const Eigen::MatrixXd inverse = dense_of(f.K).inverse();
  for (int a = 0; a < 4; ++a) {
    for (int b = 0; b < 4; ++b) {
      const Eigen::Matrix3d expected =
          inverse.block<3, 3>(3 * static_cast<int>(root[static_cast<std::size_t>(a)]),
                              3 * static_cast<int>(root[static_cast<std::size_t>(b)]));
      EXPECT_LT((C.block<3, 3>(3 * a, 3 * b) - expected).norm(), 1e-8 * C.norm());
    }
  }
}

TEST(Cholesky, RefusesAMatrixThatIsNotPositive) {
  Fixture f;
  f.K.diagonal[5] = -f.K.diagonal[5];
  Cholesky cholesky(dissect(f.model->graph(), f.model->unknown_places(), {}));
  EXPECT_FALSE(cholesky.factorize(f.K));
}

TEST(Dissection, EveryNodeStandsInOneFrontAndBoundariesAreLater) {
  const Fixture f;
  const Dissection plan = dissect(f.model->graph(), f.model->unknown_places(), {});
  std::vector<int> count(f.model->n_unknowns(), 0);
  for (const FrontPlan& front : plan.fronts) {
    for (const std::uint32_t n : front.own) ++count[n];
    for (const std::uint32_t n : front.own) {
      for (const std::uint32_t b : front.boundary) EXPECT_LT(plan.position[n], plan.position[b]);
    }
  }
  EXPECT_TRUE(std::all_of(count.begin(), count.end(), [](int c) { return c == 1; }));
  EXPECT_TRUE(plan.fronts.back().boundary.empty());
}

}  // namespace
}  // namespace artus
