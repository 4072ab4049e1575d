// SPDX-License-Identifier: AGPL-3.0-or-later
// Constructs against closed forms: bodies made of balls and planes, whose distances are known.
#include "artus/detail/anatomy/compile/labels/construct.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/anatomy/surfaces/surface_samples.h"

namespace artus {
namespace {

constexpr double kMm = 1e-3;

double ball_volume(double radius) {
  return 4.0 / 3 * std::numbers::pi * radius * radius * radius;
}

FieldSampling sample_around(double half, double spacing = 0.4 * kMm, double band = 3 * kMm) {
  return {{Vec3::Constant(-half), Vec3::Constant(half)}, spacing, band};
}

DistanceField make_field(const SurfaceMesh& mesh, double half = 40 * kMm) {
  return DistanceField::compute(DistanceTree(mesh), sample_around(half, 1 * kMm, 10 * kMm));
}

DistanceField make_ball(double radius, const Vec3& centre = Vec3::Zero()) {
  return make_field(make_sphere(centre, radius));
}

void append_hollow(SurfaceMesh& mesh, const Vec3& centre, double radius) {
  SurfaceMesh hollow = make_sphere(centre, radius);
  for (Triangle& t : hollow.triangles) std::swap(t[0], t[1]);
  append_mesh(mesh, hollow);
}

/// A block with a ball taken out of it, as a roof that vaults over a floor.
DistanceField make_vault(double radius) {
  SurfaceMesh block = make_cube(Vec3::Zero(), 60 * kMm);
  append_hollow(block, Vec3::Zero(), radius);
  return make_field(block);
}

/// All below (or above) a plane across z.
DistanceField make_half_space(double z, bool below) {
  const double half = 100 * kMm;
  return make_field(make_cube({0, 0, below ? z - half : z + half}, half), 20 * kMm);
}

double volume(const DistanceField& field) {
  return field.integrate([](const Vec3&) { return 1.0; });
}

Structure make_structure(decltype(Structure::shape) shape) {
  Structure structure;
  structure.name = "construct";
  structure.tissue = "muscle";
  structure.shape = std::move(shape);
  return structure;
}

TEST(ShellConstruct, HasItsThicknessInsideTheSurface) {
  const DistanceField body = make_ball(30 * kMm);
  for (const double thickness : {1 * kMm, 1.8 * kMm, 4 * kMm}) {
    const DistanceField shell = make_construct_field(make_structure(ShellConstruct{"", thickness}),
                                                     {{"", &body}}, sample_around(32 * kMm));
    const double expected = ball_volume(30 * kMm) - ball_volume(30 * kMm - thickness);
    EXPECT_NEAR(volume(shell), expected, 0.02 * expected) << thickness;
  }
}

constexpr double kCleft = 1.2 * kMm;

/// The cleft between a ball of 20 mm and a roof that vaults over it at `clearance`.
DistanceField make_cleft(double clearance) {
  const DistanceField floor = make_ball(20 * kMm);
  const DistanceField roof = make_vault(20 * kMm + clearance);
  GapConstruct gap;
  gap.roof = {"roof"};
  gap.floor = {"floor"};
  gap.thickness = kCleft;
  gap.within = 6 * kMm;
  return make_construct_field(make_structure(gap), {{"roof", &roof}, {"floor", &floor}},
                              sample_around(26 * kMm));
}

class GapBetweenBalls : public testing::TestWithParam<double> {};

// The roof begins this far beyond the floor; negative: they overlap, and still the cleft is whole.
TEST_P(GapBetweenBalls, HasItsThicknessHalfWayBetweenRoofAndFloor) {
  const double clearance = GetParam();
  const DistanceField cleft = make_cleft(clearance);
  const double middle = 20 * kMm + clearance / 2;
  const double expected = ball_volume(middle + kCleft / 2) - ball_volume(middle - kCleft / 2);
  EXPECT_NEAR(volume(cleft), expected, 0.03 * expected);
}

INSTANTIATE_TEST_SUITE_P(Clearances, GapBetweenBalls, testing::Values(-1e-3, 0.0, 1.5e-3, 4e-3));

TEST(GapConstruct, EndsWhereRoofAndFloorPart) {
  const DistanceField cleft = make_cleft(7 * kMm);
  EXPECT_EQ(volume(cleft), 0);
}

TEST(GapConstruct, KeepsTheLargestPartAlone) {
  // Two floors under one roof: a large ball and, apart from it, a small one.
  const Vec3 apart(24 * kMm, 0, 0);
  const DistanceField large = make_ball(10 * kMm, -0.5 * apart);
  const DistanceField small = make_ball(5 * kMm, 0.5 * apart);
  SurfaceMesh block = make_cube(Vec3::Zero(), 60 * kMm);
  append_hollow(block, -0.5 * apart, 11.5 * kMm);
  append_hollow(block, 0.5 * apart, 6.5 * kMm);
  const DistanceField roof = make_field(block);
  GapConstruct gap;
  gap.roof = {"roof"};
  gap.floor = {"large", "small"};
  gap.thickness = 1.2 * kMm;
  gap.within = 4 * kMm;
  const DistanceField cleft = make_construct_field(
      make_structure(gap), {{"roof", &roof}, {"large", &large}, {"small", &small}},
      sample_around(26 * kMm));
  EXPECT_LT(cleft.value(-0.5 * apart + Vec3(0, 10.75 * kMm, 0)), 0);
  EXPECT_GT(cleft.value(0.5 * apart + Vec3(0, 5.75 * kMm, 0)), 0);
}

class CapUnderPlane : public testing::TestWithParam<double> {};

// Bone below z = 0, what it faces above z = gap: a layer min(thickness, gap / 2) where they are
// near, thinning to half the thickness where the gap comes to `within`, and none beyond it.
TEST_P(CapUnderPlane, IsAsThickAsTheGapAllows) {
  const double gap = GetParam();
  const DistanceField bone = make_half_space(0, true);
  const DistanceField facing = make_half_space(gap, false);
  CapConstruct cap;
  cap.on = "bone";
  cap.near = {"facing"};
  cap.within = 6 * kMm;
  cap.thickness = 1.5 * kMm;
  const DistanceField field = make_construct_field(
      make_structure(cap), {{"bone", &bone}, {"facing", &facing}}, sample_around(15 * kMm));
  double top = 0;
  for (double z = -5 * kMm; z < 10 * kMm; z += 0.01 * kMm)
    if (field.value({2 * kMm, -3 * kMm, z}) < 0) top = std::max(top, z);
  const double share = std::clamp(2 * (1 - gap / cap.within), 0.0, 1.0);
  const double thickness = cap.thickness * (0.5 + 0.5 * share);
  const double expected = gap < cap.within ? std::min(thickness, gap / 2) : 0;
  EXPECT_NEAR(top, expected, 0.1 * kMm);
  EXPECT_GT(field.value({0, 0, -1 * kMm}), 0) << "a cap lies on the bone, not in it";
}

INSTANTIATE_TEST_SUITE_P(Gaps, CapUnderPlane,
                         testing::Values(1e-3, 2e-3, 3e-3, 4.5e-3, 5.5e-3, 7e-3));

TEST(EndConstruct, IsWhatLiesNearTheInsertion) {
  const double muscle_radius = 20 * kMm;
  const double reach = 12 * kMm;
  const DistanceField muscle = make_ball(muscle_radius);
  EndConstruct end;
  end.of = "muscle";
  end.toward = "bone";
  end.within = reach;
  end.insertion = Vec3(muscle_radius, 0, 0);
  const DistanceField tendon =
      make_construct_field(make_structure(end), {{"muscle", &muscle}}, sample_around(25 * kMm));
  // The lens of two balls whose centres are d apart.
  const double d = muscle_radius;
  const double sum = muscle_radius + reach;
  const double difference = muscle_radius - reach;
  const double expected = std::numbers::pi * (sum - d) * (sum - d) *
                          (d * d + 2 * d * sum - 3 * difference * difference) / (12 * d);
  EXPECT_NEAR(volume(tendon), expected, 0.02 * expected);
}

TEST(FindInsertion, IsTheMiddleOfTheContactWithTheBone) {
  const DistanceField bone = make_half_space(0, true);
  const Vec3 centre(4 * kMm, -2 * kMm, 9 * kMm);  // its lowest point is in the bone by 1 mm
  const SurfaceMesh muscle = make_sphere(centre, 10 * kMm);
  const Vec3 insertion = find_insertion(muscle, bone);
  EXPECT_NEAR(insertion.x(), centre.x(), 0.1 * kMm);
  EXPECT_NEAR(insertion.y(), centre.y(), 0.1 * kMm);
  EXPECT_LT(insertion.z(), 1 * kMm);
}

TEST(FarNeeds, CoverWhatEachConstructAsksOfItsNeighbours) {
  JointFile joint;
  joint.structures.push_back(make_structure(ShellConstruct{"", 2 * kMm}));
  CapConstruct cap;
  cap.on = "humerus";
  cap.near = {"scapula"};
  cap.within = 6 * kMm;
  cap.thickness = 1.5 * kMm;
  joint.structures.push_back(make_structure(cap));
  const auto needs = find_far_needs(joint);
  EXPECT_GE(needs.at("").band, 2 * kMm);
  EXPECT_GE(needs.at("humerus").band, 1.5 * kMm);
  EXPECT_GE(needs.at("scapula").band, 6 * kMm);
  EXPECT_EQ(needs.count("construct"), 0U);
}

TEST(FarNeeds, OfAGapInABallReachNoFartherThanTheBall) {
  JointFile joint;
  GapConstruct gap;
  gap.roof = {"deltoid"};
  gap.floor = {"humerus"};
  gap.thickness = 1.5 * kMm;
  gap.within = 8 * kMm;
  gap.centre = Vec3(0.1, 0, 0);
  gap.radius = 30 * kMm;
  joint.structures.push_back(make_structure(gap));
  const auto needs = find_far_needs(joint);
  for (const char* name : {"deltoid", "humerus"}) {
    EXPECT_GE(needs.at(name).band, 4.75 * kMm) << "half way between, and half its thickness";
    EXPECT_LE(needs.at(name).box.lower.x(), 70 * kMm);
    EXPECT_GE(needs.at(name).box.lower.x(), 60 * kMm);
  }
  // A second construct that asks for more, and everywhere.
  CapConstruct cap;
  cap.on = "humerus";
  cap.near = {"deltoid"};
  cap.within = 12 * kMm;
  cap.thickness = 1.5 * kMm;
  joint.structures.push_back(make_structure(cap));
  const auto both = find_far_needs(joint);
  EXPECT_GE(both.at("deltoid").band, 12 * kMm);
  EXPECT_LT(both.at("deltoid").box.lower.x(), -1);
}

}  // namespace
}  // namespace artus
