// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/soft/solver/needle_compliance.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include "artus/detail/soft/solver/soft_block.h"

namespace artus {
namespace {

struct Block {
  SoftBlock block;
  std::shared_ptr<const SoftModel> model;
  explicit Block(double cube, double half = 24e-3) {
    block.half_x = block.half_y = half;
    block.layers = {{36e-3, linear_material(3e3, 0.47)}};
    model = make_block_model(block, cube);
  }
};

NeedleLine straight() {
  NeedleLine track;
  track.entry = Vec3(0.7e-3, 0.4e-3, 0);
  track.length = 24e-3;
  return track;
}

/// m/N of a rigid shaft along all points.
double of_shaft(const NeedleCompliance& c) {
  const auto n = static_cast<Eigen::Index>(c.points);
  Eigen::MatrixXd C(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j)
      C(i, j) = c.by_load[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
  }
  return 1 / C.ldlt().solve(Eigen::VectorXd::Ones(n)).sum();
}

TEST(NeedleCompliance, IsSymmetricPositiveAndGrowsThinnerNeedlesAndSofterTissue) {
  const Block b(4e-3);
  const SoftSolver solver(b.model, {});
  const NeedleCompliance c = compute_needle_compliance(solver.factored(), straight());
  EXPECT_EQ(c.points, 16U);
  EXPECT_NEAR(c.spacing, 1.5e-3, 1e-12);
  for (std::size_t i = 0; i < 16; ++i) {
    for (std::size_t j = 0; j < 16; ++j) {
      EXPECT_EQ(c.by_load[i][j], c.by_load[j][i]);
      EXPECT_GT(c.by_load[i][j], 0);
      EXPECT_LE(c.by_load[i][j], c.by_load[i][i]);
    }
  }
  NeedleLine thin = straight();
  thin.radius *= 0.5;
  const NeedleCompliance of_thin = compute_needle_compliance(solver.factored(), thin);
  // The near field alone changes, by ln 2 / (2 pi mu l).
  const double shear = linear_material(3e3, 0.47).shear;
  EXPECT_NEAR(of_thin.by_load[7][7] - c.by_load[7][7],
              std::log(2) / (2 * std::numbers::pi * shear * 1.5e-3), 1e-6);
  EXPECT_EQ(of_thin.by_load[7][8], c.by_load[7][8]);
  EXPECT_NEAR(of_thin.by_load[7][7] - of_thin.near_field[7], c.by_load[7][7] - c.near_field[7],
              1e-12);
  EXPECT_GT(c.near_field[7], 0);
}

TEST(NeedleCompliance, LoadsOfAMovedShaftMoveItBack) {
  const Block b(4e-3);
  SoftSolver solver(b.model, {});
  const NeedleLine track = straight();
  const NeedleCompliance c = compute_needle_compliance(solver.factored(), track);
  NeedleLoad load;
  load.shaft[5] = 1e-4;
  load.tip = 2e-4;
  load.tip_depth = 9.5 * c.spacing;
  solver.set_loads(loads_of(load, track, c.spacing));
  solver.settle(std::nullopt, 1e-11);
  const auto at = [&](std::size_t point) {
    const Vec3 p = track.entry + (static_cast<double>(point) + 0.5) * c.spacing * track.axis;
    return b.model->displacement_at(b.model->cage().locate(p), solver.displacements()).z();
  };
  for (const std::size_t i : {std::size_t{0}, std::size_t{7}, std::size_t{14}}) {
    const double expected = 1e-4 * c.by_load[i][5] + 2e-4 * c.by_load[i][9];
    EXPECT_NEAR(at(i), expected, 5e-3 * expected) << i;
  }
  EXPECT_NEAR(solver.reaction().z(), -3e-4, 1e-9);
}

TEST(NeedleCompliance, DoesNotDependOnTheCubesNorOnWhereTheTrackPassesThem) {
  std::vector<double> found;
  for (const double cube : {3e-3, 4e-3, 6e-3}) {
    const Block b(cube);
    const SoftSolver solver(b.model, {});
    found.push_back(of_shaft(compute_needle_compliance(solver.factored(), straight())));
    NeedleLine between = straight();
    between.entry = Vec3(0.5 * cube, 0.5 * cube, 0);
    found.push_back(of_shaft(compute_needle_compliance(solver.factored(), between)));
  }
  const auto [low, high] = std::minmax_element(found.begin(), found.end());
  EXPECT_LT(*high, 1.1 * *low) << found[0] << " " << found[1] << " " << found[2] << " " << found[3]
                               << " " << found[4] << " " << found[5];
}

TEST(NeedleCompliance, StaysThatOfAFactorWhichIsHeldWhileTheSolverMakesOthers) {
  const Block b(4e-3);
  SoftSolver solver(b.model, {});
  const FactoredModel held = solver.factored();
  const NeedleCompliance before = compute_needle_compliance(held, straight());
  solver.set_loads({{Vec3(0, 0, 3e-3), Vec3(0, 0, 0.3)}});
  for (int i = 0; i < 3; ++i) {  // each makes one factor, and the spare one is the held one
    solver.settle(std::nullopt, 1e-9);
    ASSERT_TRUE(solver.refresh());
  }
  EXPECT_EQ(compute_needle_compliance(held, straight()).by_load, before.by_load);
  EXPECT_NE(compute_needle_compliance(solver.factored(), straight()).by_load, before.by_load);
}

}  // namespace
}  // namespace artus
