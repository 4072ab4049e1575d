// SPDX-License-Identifier: AGPL-3.0-or-later
// Clefts on shapes whose distances are known: fluid lies between roof and floor and nowhere else.
#include "artus/detail/anatomy/compile/labels/gap.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/anatomy/surfaces/surface_samples.h"

namespace artus {
namespace {

constexpr double kMm = 1e-3;

FieldSampling sample_around(double half, double spacing = 0.4 * kMm, double band = 3 * kMm) {
  return {{Vec3::Constant(-half), Vec3::Constant(half)}, spacing, band};
}

DistanceField make_field(const SurfaceMesh& mesh) {
  return DistanceField::compute(DistanceTree(mesh), sample_around(30 * kMm, 0.5 * kMm, 10 * kMm));
}

SurfaceMesh make_block(const Vec3& lower, const Vec3& upper) {
  SurfaceMesh mesh = make_cube(Vec3::Zero(), 1);
  for (Vec3& p : mesh.vertices) p = lower + (p + Vec3::Ones()).cwiseProduct(upper - lower) / 2;
  return mesh;
}

/// A ball's wall.
SurfaceMesh make_wall(double inner, double outer) {
  SurfaceMesh wall = make_sphere(Vec3::Zero(), outer);
  SurfaceMesh hollow = make_sphere(Vec3::Zero(), inner);
  for (Triangle& t : hollow.triangles) std::swap(t[0], t[1]);
  append_mesh(wall, hollow);
  return wall;
}

GapConstruct make_gap(double thickness, double within) {
  GapConstruct gap;
  gap.roof = {"roof"};
  gap.floor = {"floor"};
  gap.thickness = thickness;
  gap.within = within;
  return gap;
}

double volume(const DistanceField& field) {
  return field.integrate([](const Vec3&) { return 1.0; });
}

/// How thick the fluid is along z at (x, y).
double thickness_at(const DistanceField& field, double x, double y) {
  constexpr double kStep = 0.01 * kMm;
  double sum = 0;
  for (double z = -10 * kMm; z < 20 * kMm; z += kStep)
    if (field.value({x, y, z}) < 0) sum += kStep;
  return sum;
}

/// How far the fluid reaches along x.
double reach_of(const DistanceField& field) {
  constexpr double kStep = 0.1 * kMm;
  double reach = -1;
  for (double x = -20 * kMm; x < 25 * kMm; x += kStep)
    for (double z = -5 * kMm; z < 15 * kMm; z += kStep)
      if (field.value({x, 2 * kMm, z}) < 0) reach = std::max(reach, x);
  return reach;
}

const Vec3 kFloorLower(-0.1, -0.1, -0.1);
const Vec3 kFloorUpper(0.1, 0.1, 0);

class RoofThatEnds : public testing::TestWithParam<double> {};

// A flat floor, and above it at some height a roof that ends at x = 0: there fluid ends, too.
TEST_P(RoofThatEnds, EndsTheFluidWithinARimOfItsEdge) {
  const double height = GetParam();
  const DistanceField floor = make_field(make_block(kFloorLower, kFloorUpper));
  const DistanceField roof = make_field(make_block({-0.1, -0.1, height}, {0, 0.1, 0.1}));
  const GapConstruct gap = make_gap(1.5 * kMm, 8 * kMm);
  const GapField made =
      make_gap_field(gap, {{"roof", &roof}, {"floor", &floor}}, {}, sample_around(25 * kMm));
  EXPECT_NEAR(thickness_at(made.field, -10 * kMm, 2 * kMm), gap.thickness, 0.1 * kMm);
  const double reach = reach_of(made.field);
  EXPECT_GT(reach, -1 * kMm);
  EXPECT_LE(reach, gap.thickness + 0.4 * kMm) << "no farther than the rim is wide";
  double last = 10;
  for (double x = -4 * kMm; x < reach; x += 0.5 * kMm) {
    const double here = thickness_at(made.field, x, 2 * kMm);
    EXPECT_LT(here, last + 0.2 * kMm) << "grows again at " << x;
    last = here;
  }
}
INSTANTIATE_TEST_SUITE_P(Heights, RoofThatEnds, testing::Values(1.5e-3, 3e-3, 6e-3));

TEST(Gap, AWiderEdgeReachesFartherAndIsThinner) {
  const DistanceField floor = make_field(make_block(kFloorLower, kFloorUpper));
  const DistanceField roof = make_field(make_block({-0.1, -0.1, 4 * kMm}, {0, 0.1, 0.1}));
  GapConstruct gap = make_gap(1.5 * kMm, 12 * kMm);
  const NamedFields fields{{"roof", &roof}, {"floor", &floor}};
  const auto narrow = make_gap_field(gap, fields, {}, sample_around(25 * kMm));
  gap.edge = 3.5 * kMm;
  const auto wide = make_gap_field(gap, fields, {}, sample_around(25 * kMm));
  EXPECT_GT(reach_of(wide.field), reach_of(narrow.field) + 0.8 * kMm);
  EXPECT_LE(reach_of(wide.field), gap.edge + 0.4 * kMm);
}

TEST(Gap, IsNotOnTheOuterSideOfAThinRoof) {
  const DistanceField floor = make_field(make_sphere(Vec3::Zero(), 15 * kMm));
  const DistanceField capsule = make_field(make_wall(15.3 * kMm, 16.3 * kMm));
  const GapField made =
      make_gap_field(make_gap(1.5 * kMm, 8 * kMm), {{"roof", &capsule}, {"floor", &floor}}, {},
                     sample_around(25 * kMm));
  double outermost = 0;
  for (double x = 0; x < 25 * kMm; x += 0.05 * kMm)
    if (made.field.value({x, 0.3 * x, 0.2 * x}) < 0)
      outermost = std::max(outermost, Vec3(x, 0.3 * x, 0.2 * x).norm());
  EXPECT_GT(outermost, 15.2 * kMm);
  EXPECT_LT(outermost, 16.3 * kMm);
}

// Parallel walls, so that the ball alone ends the fluid: its rim is an ellipse's.
TEST(Gap, ThinsOutAsAnEllipseWhereTheBallEndsIt) {
  const DistanceField floor = make_field(make_block(kFloorLower, kFloorUpper));
  const DistanceField roof = make_field(make_block({-0.1, -0.1, 2 * kMm}, {0.1, 0.1, 0.1}));
  GapConstruct gap = make_gap(1.5 * kMm, 8 * kMm);
  gap.centre = {0, 0, 1 * kMm};
  gap.radius = 12 * kMm;
  gap.edge = 4 * kMm;
  const GapField made =
      make_gap_field(gap, {{"roof", &roof}, {"floor", &floor}}, {}, sample_around(25 * kMm));
  for (const double share : {0.0, 0.25, 0.5, 0.75, 0.9}) {
    const double x = gap.radius - gap.edge * (1 - share);
    EXPECT_NEAR(thickness_at(made.field, x, 0), gap.thickness * std::sqrt(1 - share * share),
                0.15 * kMm)
        << share;
  }
  EXPECT_EQ(thickness_at(made.field, gap.radius + 0.3 * kMm, 0), 0);
}

TEST(Gap, LeavesOtherTissueItsPlaceAndTellsWhereAndHowMuch) {
  const DistanceField floor = make_field(make_block(kFloorLower, kFloorUpper));
  const DistanceField roof = make_field(make_block({-0.1, -0.1, 1.5 * kMm}, {0.1, 0.1, 0.1}));
  const Vec3 place(4 * kMm, -3 * kMm, 1 * kMm);
  const DistanceField nerve = make_field(make_cube(place, 3 * kMm));
  const DistanceField far = make_field(make_cube({0, 0, -20 * kMm}, 3 * kMm));
  GapConstruct gap = make_gap(1.5 * kMm, 8 * kMm);
  gap.radius = 15 * kMm;
  const GapField made =
      make_gap_field(gap, {{"roof", &roof}, {"floor", &floor}}, {{"nerve", &nerve}, {"far", &far}},
                     sample_around(20 * kMm, 0.25 * kMm));
  for (double x = -2.9; x < 3; x += 0.5)
    for (double y = -2.9; y < 3; y += 0.5)
      EXPECT_GE(made.field.value(place + kMm * Vec3(x, y, 0)), 0) << x << ' ' << y;
  ASSERT_EQ(made.cuts.size(), 1U);
  EXPECT_EQ(made.cuts[0].by, "nerve");
  EXPECT_NEAR(made.cuts[0].part.volume, 6 * 6 * 1.5 * 1e-9, 0.05 * 54e-9);
  EXPECT_NEAR((made.cuts[0].part.centre - Vec3(4, -3, 0.75) * kMm).norm(), 0, 0.1 * kMm);
  const GapField alone = make_gap_field(gap, {{"roof", &roof}, {"floor", &floor}}, {},
                                        sample_around(20 * kMm, 0.25 * kMm));
  EXPECT_NEAR(volume(alone.field) - volume(made.field), 54e-9, 0.1 * 54e-9);
}

TEST(Gap, TellsThePartsThatAreNotJoinedToTheLargest) {
  // Two floors under one roof, a wide and a narrow one.
  const DistanceField floor = make_field([] {
    SurfaceMesh two = make_block({-20 * kMm, -0.1, -0.1}, {-2 * kMm, 0.1, 0});
    append_mesh(two, make_block({8 * kMm, -0.1, -0.1}, {14 * kMm, 0.1, 0}));
    return two;
  }());
  const DistanceField roof = make_field(make_block({-0.1, -0.1, 1.5 * kMm}, {0.1, 0.1, 0.1}));
  GapConstruct gap = make_gap(1.5 * kMm, 3 * kMm);
  gap.radius = 18 * kMm;
  const GapField made =
      make_gap_field(gap, {{"roof", &roof}, {"floor", &floor}}, {}, sample_around(20 * kMm));
  EXPECT_LT(made.field.value({-10 * kMm, 0, 0.75 * kMm}), 0);
  EXPECT_GT(made.field.value({11 * kMm, 0, 0.75 * kMm}), 0);
  ASSERT_FALSE(made.cuts.empty());
  EXPECT_TRUE(made.cuts[0].by.empty());
  EXPECT_NEAR(made.cuts[0].part.centre.x(), 11 * kMm, 0.5 * kMm);
  EXPECT_GT(made.cuts[0].part.volume, 100e-9);
}

TEST(Gap, IsNotUnderAHoleOfTheRoof) {
  const DistanceField floor = make_field(make_block(kFloorLower, kFloorUpper));
  // Four blocks around a square opening of 12 mm.
  const DistanceField roof = make_field([] {
    constexpr double kHalf = 6 * kMm;
    constexpr double kLow = 1.5 * kMm;
    SurfaceMesh mesh = make_block({-0.1, -0.1, kLow}, {-kHalf, 0.1, 6 * kMm});
    append_mesh(mesh, make_block({kHalf, -0.1, kLow}, {0.1, 0.1, 6 * kMm}));
    append_mesh(mesh, make_block({-7 * kMm, -0.1, kLow}, {7 * kMm, -kHalf, 6 * kMm}));
    append_mesh(mesh, make_block({-7 * kMm, kHalf, kLow}, {7 * kMm, 0.1, 6 * kMm}));
    return mesh;
  }());
  const GapConstruct gap = make_gap(1.5 * kMm, 8 * kMm);
  const GapField made =
      make_gap_field(gap, {{"roof", &roof}, {"floor", &floor}}, {}, sample_around(20 * kMm));
  for (const double x : {-3.0, 0.0, 3.0})
    EXPECT_EQ(thickness_at(made.field, x * kMm, 0), 0) << x << " mm: beyond the rim of its edge";
  EXPECT_NEAR(thickness_at(made.field, 12 * kMm, 0), gap.thickness, 0.1 * kMm);
  EXPECT_NEAR(thickness_at(made.field, 0, -12 * kMm), gap.thickness, 0.1 * kMm);
}

TEST(Gap, TakesItsThicknessOfWallsThatTouchOrOverlap) {
  const DistanceField floor = make_field(make_block(kFloorLower, kFloorUpper));
  for (const double at : {0.0, -0.4 * kMm}) {
    const DistanceField roof = make_field(make_block({-0.1, -0.1, at}, {0.1, 0.1, 0.1}));
    const GapField made =
        make_gap_field(make_gap(1.5 * kMm, 8 * kMm), {{"roof", &roof}, {"floor", &floor}}, {},
                       sample_around(20 * kMm));
    EXPECT_NEAR(thickness_at(made.field, 3 * kMm, -5 * kMm), 1.5 * kMm, 0.1 * kMm) << at;
    EXPECT_TRUE(made.cuts.empty()) << at;
  }
}

TEST(Gap, UnderASmallRoofIsAsLargeAsTheRoof) {
  const DistanceField floor = make_field(make_block(kFloorLower, kFloorUpper));
  const double half = 9 * kMm;
  const DistanceField roof =
      make_field(make_block({-half, -half, 1.5 * kMm}, {half, half, 6 * kMm}));
  const GapConstruct gap = make_gap(1.5 * kMm, 8 * kMm);
  const GapField made =
      make_gap_field(gap, {{"roof", &roof}, {"floor", &floor}}, {}, sample_around(20 * kMm));
  const double under = 4 * half * half * gap.thickness;
  const double with_rim = 4 * std::pow(half + gap.thickness, 2) * gap.thickness;
  EXPECT_GT(volume(made.field), 0.95 * under);
  EXPECT_LT(volume(made.field), with_rim);
}

TEST(Gap, IsTheSameHoweverItsWallsAreTurned) {
  GapConstruct gap = make_gap(1.5 * kMm, 8 * kMm);
  gap.radius = 12 * kMm;
  gap.edge = 3 * kMm;
  const auto volume_turned = [&](double angle) {
    const Eigen::Matrix3d turn =
        Eigen::AngleAxisd(angle, Vec3(1, 0.4, 0.2).normalized()).toRotationMatrix();
    const auto turned = [&](SurfaceMesh mesh) {
      for (Vec3& p : mesh.vertices) p = turn * p;
      return make_field(mesh);
    };
    const DistanceField floor = turned(make_block(kFloorLower, kFloorUpper));
    const DistanceField roof = turned(make_block({-0.1, -0.1, 2 * kMm}, {0.1, 0.1, 0.1}));
    gap.centre = turn * Vec3(0, 0, 1 * kMm);
    return volume(make_gap_field(gap, {{"roof", &roof}, {"floor", &floor}}, {},
                                 sample_around(20 * kMm, 0.3 * kMm))
                      .field);
  };
  const double straight = volume_turned(0);
  EXPECT_GT(straight, 0.7 * std::numbers::pi * 144 * 1.5 * 1e-9);
  for (const double angle : {0.3, 0.8, 1.4})
    EXPECT_NEAR(volume_turned(angle), straight, 0.03 * straight) << angle;
}

TEST(KeepLargestPart, DropsTheSmallerOfTwoBallsAndSaysWhatBothHold) {
  SurfaceMesh balls = make_sphere({-10 * kMm, 0, 0}, 8 * kMm);
  append_mesh(balls, make_sphere({9 * kMm, 1 * kMm, 0}, 6 * kMm));
  DistanceField field =
      DistanceField::compute(DistanceTree(balls), sample_around(20 * kMm, 0.4 * kMm, 1 * kMm));
  const auto parts = field.keep_largest_part();
  ASSERT_EQ(parts.size(), 2U);
  const auto ball = [](double r) {
    return 4.0 / 3 * std::numbers::pi * r * r * r;
  };
  EXPECT_NEAR(parts[0].volume, ball(8 * kMm), 0.02 * ball(8 * kMm));
  EXPECT_NEAR(parts[1].volume, ball(6 * kMm), 0.02 * ball(6 * kMm));
  EXPECT_NEAR((parts[1].centre - Vec3(9, 1, 0) * kMm).norm(), 0, 0.1 * kMm);
  EXPECT_NEAR(volume(field), ball(8 * kMm), 0.02 * ball(8 * kMm));
  EXPECT_LT(field.value({-10 * kMm, 0, 0}), 0);
  EXPECT_GT(field.value({9 * kMm, 1 * kMm, 0}), 0) << "also where blocks were wholly inside";
}

}  // namespace
}  // namespace artus
