// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/meshes/generate/solids/field.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "artus/detail/meshes/generate/solids/sweep.h"

namespace artus {
namespace {

std::vector<Vec3> scattered_points() {
  std::vector<Vec3> points;
  for (int i = -3; i <= 3; ++i) {
    for (int j = -3; j <= 3; ++j) {
      for (int k = -3; k <= 3; ++k) points.emplace_back(0.31 * i + 0.01, 0.29 * j, 0.27 * k - 0.02);
    }
  }
  return points;
}

TEST(Field, BallIsTheDistanceToItsSurface) {
  const Field ball = make_ball(Vec3(1, 2, 3), 0.5);
  EXPECT_NEAR(ball(Vec3(1, 2, 3)), -0.5, 1e-15);
  EXPECT_NEAR(ball(Vec3(1, 2, 5)), 1.5, 1e-15);
}

TEST(Field, EllipsoidWithEqualAxesIsABall) {
  const Field ball = make_ball(Vec3::Zero(), 0.5);
  const Field round = make_ellipsoid(Vec3::Zero(), Vec3::Constant(0.5));
  for (const Vec3& p : scattered_points()) EXPECT_NEAR(round(p), ball(p), 1e-12);
}

TEST(Field, EllipsoidIsZeroAtTheEndsOfItsTurnedAxes) {
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.7, Vec3(1, 1, 0).normalized()).matrix();
  const Field field = make_ellipsoid(Vec3(0.1, 0, 0), Vec3(0.3, 0.2, 0.1), turn);
  EXPECT_NEAR(field(Vec3(0.1, 0, 0) + 0.3 * turn.col(0)), 0, 1e-12);
  EXPECT_NEAR(field(Vec3(0.1, 0, 0) - 0.1 * turn.col(2)), 0, 1e-12);
  EXPECT_LT(field(Vec3(0.1, 0, 0)), 0);
}

TEST(Field, CushionIsThickestInItsMiddleAndThinsOutToItsRimOnTheSideItLiesOn) {
  const Field side = make_ball(Vec3::Zero(), 1);
  Eigen::Matrix3d axes;
  axes << Vec3::UnitX(), -Vec3::UnitY(), -Vec3::UnitZ();
  const Field cushion = make_cushion(side, 0.1, Vec3(0, 0, -1.1), Vec3(0.5, 0.4, 0.1), axes);
  EXPECT_NEAR(cushion(Vec3(0, 0, -1)), 0, 1e-9);
  EXPECT_NEAR(cushion(Vec3(0, 0, -1.2)), 0, 1e-9);
  EXPECT_LT(cushion(Vec3(0, 0, -1.1)), -0.09);
  const auto thickness = [&](double degrees) {
    const double angle = degrees * std::numbers::pi / 180;
    const Vec3 out(std::sin(angle), 0, -std::cos(angle));
    double sum = 0;
    for (double r = 0.9; r < 1.4; r += 1e-3) sum += cushion(r * out) < 0 ? 1e-3 : 0;
    return sum;
  };
  EXPECT_NEAR(thickness(0), 0.2, 5e-3);
  EXPECT_LT(thickness(20), thickness(10));
  EXPECT_EQ(thickness(30), 0);
  EXPECT_GT(cushion(Vec3(0, 0, 1.1)), 0) << "nothing on the far side";
}

TEST(Field, UnionWithoutBlendIsTheNearerOfBoth) {
  const Field a = make_ball(Vec3(-0.2, 0, 0), 0.4);
  const Field b = make_ball(Vec3(0.3, 0, 0), 0.3);
  const Field both = unite(a, b, 0);
  for (const Vec3& p : scattered_points()) EXPECT_EQ(both(p), std::min(a(p), b(p)));
}

TEST(Field, BlendOnlyAddsToAUnionAndNeverMoreThanAQuarterOfItsWidth) {
  const Field a = make_ball(Vec3(-0.2, 0, 0), 0.4);
  const Field b = make_ball(Vec3(0.3, 0, 0), 0.3);
  const Field both = unite(a, b, 0.2);
  for (const Vec3& p : scattered_points()) {
    const double sharp = std::min(a(p), b(p));
    EXPECT_LE(both(p), sharp);
    EXPECT_GE(both(p), sharp - 0.25 * 0.2 - 1e-12);
  }
}

TEST(Field, SubtractionLeavesWhatLiesInTheFirstAndNotInTheSecond) {
  const Field a = make_ball(Vec3(-0.2, 0, 0), 0.4);
  const Field b = make_half_space(Vec3::Zero(), Vec3(0, 0, 1));
  const Field rest = subtract(a, b, 0);
  const Field shared = intersect(a, b, 0);
  for (const Vec3& p : scattered_points()) {
    EXPECT_EQ(rest(p) < 0, a(p) < 0 && b(p) > 0);
    EXPECT_EQ(shared(p) < 0, a(p) < 0 && b(p) < 0);
  }
}

TEST(Sweep, StraightTubeIsACapsule) {
  const Field tube = make_tube({{Vec3(0, 0, 0), 0.1}, {Vec3(0, 0, 1), 0.1}});
  EXPECT_NEAR(tube(Vec3(0.3, 0, 0.5)), 0.2, 1e-12);
  EXPECT_NEAR(tube(Vec3(0, 0, 1.5)), 0.4, 1e-12);
  EXPECT_NEAR(tube(Vec3(0, 0, 0.25)), -0.1, 1e-12);
}

TEST(Sweep, TubePassesThroughItsStations) {
  const std::vector<TubeStation> course{{Vec3(0, 0, 0), 0.05},
                                        {Vec3(0.3, 0.1, 0), 0.07},
                                        {Vec3(0.5, 0.4, 0.1), 0.04},
                                        {Vec3(0.4, 0.8, 0), 0.05}};
  const Field tube = make_tube(course);
  for (const TubeStation& s : course) EXPECT_NEAR(tube(s.centre), -s.radius, 1e-12);
}

TEST(Sweep, RibbonHasItsWidthAndThickness) {
  const Field ribbon = make_ribbon(
      {{Vec3(0, 0, 0), Vec3::UnitZ(), 0.2, 0.05}, {Vec3(1, 0, 0), Vec3::UnitZ(), 0.2, 0.05}});
  EXPECT_NEAR(ribbon(Vec3(0.5, 0.2, 0)), 0, 1e-12);
  EXPECT_NEAR(ribbon(Vec3(0.5, 0, -0.05)), 0, 1e-12);
  EXPECT_LT(ribbon(Vec3(0.5, 0, 0)), 0);
}

TEST(Sweep, RingIsClosed) {
  std::vector<Vec3> points;
  for (int i = 0; i < 12; ++i) {
    points.emplace_back(std::cos(i * std::numbers::pi / 6), std::sin(i * std::numbers::pi / 6), 0);
  }
  const Field ring = make_ring(points, 0.1);
  for (int i = 0; i < 48; ++i) {
    const double angle = i * std::numbers::pi / 24;
    EXPECT_NEAR(ring(Vec3(std::cos(angle), std::sin(angle), 0.3)), 0.2, 5e-3) << i;
  }
}

TEST(Sweep, PlateIsTheDistanceToItsTriangleLessItsRadius) {
  const Field plate = make_plate({{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)}}, 0.1);
  EXPECT_NEAR(plate(Vec3(0.2, 0.2, 0.5)), 0.4, 1e-12);
  EXPECT_NEAR(plate(Vec3(0.2, 0.2, -0.5)), 0.4, 1e-12);
  EXPECT_NEAR(plate(Vec3(-1, 0.5, 0)), 0.9, 1e-12);
  EXPECT_NEAR(plate(Vec3(1, 1, 0)), std::sqrt(0.5) - 0.1, 1e-12);
}

TEST(Field, RibbonOfAHigherPowerKeepsItsThicknessTowardItsEdges) {
  const std::vector<RibbonStation> stations{{Vec3(-1, 0, 0), Vec3::UnitZ(), 0.4, 0.1},
                                            {Vec3(1, 0, 0), Vec3::UnitZ(), 0.4, 0.1}};
  const Field ellipse = make_ribbon(stations);
  const Field band = make_ribbon(stations, 4);
  for (const Field& field : {ellipse, band}) {
    EXPECT_NEAR(field(Vec3(0, 0.4, 0)), 0, 1e-12);
    EXPECT_NEAR(field(Vec3(0, 0, 0.1)), 0, 1e-12);
  }
  const Vec3 corner(0, 0.3, 0.08);
  EXPECT_GT(ellipse(corner), 0);
  EXPECT_LT(band(corner), 0);
}

TEST(Field, FarBesideAThinRibbonTheValueIsNoLessThanTheDistanceToItsBox) {
  const Field thin = make_ribbon(
      {{Vec3(-1, 0, 0), Vec3::UnitZ(), 0.5, 0.01}, {Vec3(1, 0, 0), Vec3::UnitZ(), 0.5, 0.01}});
  EXPECT_GE(thin(Vec3(0, 1.5, 0.05)), 1 - 1e-12);
  EXPECT_LE(thin(Vec3(0, 1.5, 0.05)), 1.05);
}

}  // namespace
}  // namespace artus
