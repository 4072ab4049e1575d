// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/soft/solver/smooth_gradient.h"

#include <array>

#include <gtest/gtest.h>

#include "tests/support/moved_block.h"

namespace artus {
namespace {

test::MovedBlock muscle() {
  const std::array<FlatLayer, 1> layers{{{"muscle", 48e-3}}};
  return test::make_moved_block(layers);
}

TEST(SmoothGradient, OfAnEvenDeformationIsThatOfTheCubes) {
  Eigen::Matrix3d G;
  G << 0.1, 0.02, -0.03, 0, -0.2, 0.05, 0.04, 0.01, -0.1;
  const auto body = muscle().moved([&](const Vec3& p) { return Vec3(G * p); });
  const SmoothGradient smooth(body);
  const Eigen::Matrix3d F = G + Eigen::Matrix3d::Identity();
  for (const Vec3& p : {Vec3(1e-3, 2e-3, 7e-3), Vec3(-11e-3, 5e-3, 30e-3), Vec3(0, 0, 6e-3)}) {
    const auto there = body->motion_in_cage(body->to_cage() * p);
    EXPECT_LT((smooth.at(body->to_cage() * p, there.cell) - F).norm(), 1e-6);
  }
  EXPECT_EQ(smooth.at(Vec3::Zero(), -1), Eigen::Matrix3d(Eigen::Matrix3d::Identity()));
}

TEST(SmoothGradient, HasNoStepsWhereTheCubesHaveThem) {
  const double bend = 5;  // 1/m; cubes of 3 mm make steps of 0.03 of it
  const auto body = muscle().moved([&](const Vec3& p) { return Vec3(0, 0, bend * p.x() * p.x()); });
  const SmoothGradient smooth(body);
  double most = 0;
  for (double x = -12.05e-3; x < 12e-3; x += 0.1e-3) {
    const Vec3 p_C = body->to_cage() * Vec3(x, 0.7e-3, 10e-3);
    const auto there = body->motion_in_cage(p_C);
    EXPECT_NEAR(smooth.at(p_C, there.cell)(2, 0), 2 * bend * x, 1e-6);
    most = std::max(most, std::abs(there.motion.gradient(2, 0) - 2 * bend * x));
  }
  EXPECT_GT(most, 0.014) << "the cubes' own";
}

TEST(SmoothGradient, CarriesNormalsAsPlanesGo) {
  Eigen::Matrix3d F = Eigen::Matrix3d::Identity();
  F(0, 2) = 0.3;
  F(1, 1) = 0.7;
  F(2, 0) = -0.2;
  const Vec3 a(1, 0.2, 0.5);
  const Vec3 b(-0.3, 1, 0.4);
  const Vec3 normal = carried_normal(F, a.cross(b));
  EXPECT_LT((normal - (F * a).cross(F * b)).norm(), 1e-12);
}

}  // namespace
}  // namespace artus
