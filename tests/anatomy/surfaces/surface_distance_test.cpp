// SPDX-License-Identifier: AGPL-3.0-or-later
// Distances between surfaces against closed forms.
#include "artus/detail/anatomy/surfaces/surface_distance.h"

#include <gtest/gtest.h>

#include "tests/anatomy/surfaces/surface_samples.h"

namespace artus {
namespace {

/// A square of side 2 `half` at height `z`, two triangles.
SurfaceMesh make_square(double half, double z) {
  SurfaceMesh mesh;
  for (const double y : {-half, half})
    for (const double x : {-half, half}) mesh.vertices.emplace_back(x, y, z);
  mesh.triangles = {{0, 1, 3}, {0, 3, 2}};
  return mesh;
}

TEST(SurfaceDistance, OfAShiftedSquareIsTheShift) {
  const auto d = measure_distance(make_square(0.05, 0), make_square(0.05, 0.002));
  EXPECT_NEAR(d.mean, 0.002, 1e-12);
  EXPECT_NEAR(d.percentile95, 0.002, 1e-12);
  EXPECT_NEAR(d.max, 0.002, 1e-12);
}

TEST(SurfaceDistance, OfASurfaceToItselfIsZero) {
  const auto mesh = make_sphere(Vec3::Zero(), 0.02);
  EXPECT_EQ(measure_distance(mesh, mesh).max, 0);
}

// All vertices of the roof lie on the square or beyond it; only points within its triangles and the
// way from the square to it tell that a ridge stands off by 3 mm.
TEST(SurfaceDistance, SeesWhatLiesBetweenVerticesAndWhatOnlyOneSurfaceHas) {
  SurfaceMesh tent;
  tent.vertices = {Vec3(-0.05, -0.05, 0), Vec3(0.05, -0.05, 0),  Vec3(0.05, 0.05, 0),
                   Vec3(-0.05, 0.05, 0),  Vec3(0, -0.05, 0.003), Vec3(0, 0.05, 0.003)};
  tent.triangles = {{0, 4, 5}, {0, 5, 3}, {4, 1, 2}, {4, 2, 5}};
  const auto there = measure_distance(tent, make_square(0.05, 0));
  const auto back = measure_distance(make_square(0.05, 0), tent);
  EXPECT_NEAR(there.max, 0.003, 0.05e-3);
  EXPECT_EQ(there.max, back.max) << "both ways either way";
  EXPECT_NEAR(there.mean, 0.0015, 0.03e-3);
  EXPECT_NEAR(there.percentile95, 0.95 * 0.003, 0.05e-3);
}

// Every vertex of the small square lies on the large one; half of the large one is 50 mm away.
TEST(SurfaceDistance, IsTheWorseOfBothWays) {
  SurfaceMesh strip = make_square(0.05, 0);
  for (Vec3& p : strip.vertices) p.x() = p.x() > 0 ? 0 : p.x();
  const auto d = measure_distance(strip, make_square(0.05, 0));
  EXPECT_NEAR(d.max, 0.05, 1e-9);
  EXPECT_NEAR(d.mean, 0.0125, 0.2e-3) << "half of it at zero, half from zero to 50 mm";
}

TEST(SurfaceDistance, OfTwoBallsIsTheDifferenceOfTheirRadii) {
  const auto d =
      measure_distance(make_sphere(Vec3::Zero(), 0.020), make_sphere(Vec3::Zero(), 0.021));
  EXPECT_NEAR(d.mean, 1e-3, 0.02e-3);
  EXPECT_NEAR(d.max, 1e-3, 0.1e-3) << "flat faces of a ball of 40 by 80";
}

TEST(SurfaceSamples, StandForTheWholeAreaAndLieWithinTheTriangle) {
  const std::array<Vec3, 3> corners{Vec3::Zero(), Vec3(0.01, 0, 0), Vec3(0, 0.02, 0)};
  std::vector<SurfaceSample> samples;
  append_samples(corners, 0.001, samples);
  double area = 0;
  Vec3 centre = Vec3::Zero();
  for (const auto& s : samples) {
    area += s.area;
    centre += s.area * s.position;
    EXPECT_GE(s.position.x(), 0);
    EXPECT_GE(s.position.y(), 0);
    EXPECT_LE(s.position.x() / 0.01 + s.position.y() / 0.02, 1 + 1e-12);
  }
  EXPECT_NEAR(area, 1e-4, 1e-15);
  EXPECT_NEAR((centre / area - Vec3(0.01, 0.02, 0) / 3).norm(), 0, 1e-12);
  EXPECT_GT(samples.size(), 400U) << "parts of a millimetre";
}

}  // namespace
}  // namespace artus
