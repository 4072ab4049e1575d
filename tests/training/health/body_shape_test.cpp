// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/training/health/body_shape.h"

#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/support/meshed_block.h"

namespace artus {
namespace {

const std::vector<FlatLayer> kLayers{{"skin", 2e-3}, {"muscle", 10e-3}, {"bone", 4e-3}};

TEST(BodyShape, ATetrahedronTurnedOverIsFoundWithItsRegionAndPlace) {
  const TetMesh rest = test::make_meshed_block(kLayers, 20e-3, 20e-3, 2.5e-3).mesh;
  const LeastRatio same = find_least_ratio(rest, rest);
  EXPECT_EQ(same.inverted, 0U);
  EXPECT_GT(same.compared, rest.tetrahedra.size() / 2);
  EXPECT_NEAR(same.ratio, 1, 1e-9);

  TetMesh pushed = rest;
  const auto& tet = rest.tetrahedra[rest.tetrahedra.size() / 2];
  const Vec3 face = (rest.vertices[tet[0]] + rest.vertices[tet[1]] + rest.vertices[tet[2]]) / 3;
  pushed.vertices[tet[3]] += 2.5 * (face - rest.vertices[tet[3]]);
  const LeastRatio turned = find_least_ratio(rest, pushed);
  EXPECT_GT(turned.inverted, 0U);
  EXPECT_LT(turned.ratio, -1);
  EXPECT_GE(turned.region, kFirstRegion);
  EXPECT_LT((turned.p_J - rest.vertices[tet[3]]).norm(), 6e-3);
}

TEST(BodyShape, BodiesOfOtherTetrahedraAreNotCompared) {
  const TetMesh rest = test::make_meshed_block(kLayers, 20e-3, 20e-3, 2.5e-3).mesh;
  TetMesh other = rest;
  other.tetrahedra.pop_back();
  EXPECT_EQ(find_least_ratio(rest, other).compared, 0U);
}

TEST(BodyShape, PointsThatAreNotFiniteAreCounted) {
  std::vector<Vec3> points(5, Vec3::Ones());
  EXPECT_EQ(count_not_finite(points), 0U);
  points[1].y() = std::numeric_limits<double>::quiet_NaN();
  points[4].z() = std::numeric_limits<double>::infinity();
  EXPECT_EQ(count_not_finite(points), 2U);
}

TEST(BodyShape, RaysFindABallsVolume) {
  BlockWithSphere body;
  body.tissue = "muscle";
  body.size = Vec3(60e-3, 60e-3, 40e-3);
  body.inclusion = "bursa";
  body.centre = Vec3(3e-3, 0, 20e-3);
  body.radius = 8e-3;
  const Scene scene(std::make_shared<const CompiledJoint>(test::make_block_with_sphere(body)));
  const std::vector<std::string> names{"inclusion"};
  const std::vector<bool> regions = regions_named(scene.joint(), names);
  const RayGrid grid =
      grid_around(points_of(scene.joint(), regions), Eigen::Matrix3d::Identity(), 20000);
  const double ball = 4.0 / 3 * std::numbers::pi * std::pow(body.radius, 3);
  EXPECT_NEAR(volume_along(scene, grid, regions), ball, 0.01 * ball);
}

/// Layers whose skin is raised by `lift` m in a square of 20 mm.
CompiledJoint raised(double lift, int times = 4) {
  CompiledJoint joint = subdivided(test::make_layered_block(kLayers, 40e-3, 40e-3), times);
  for (Vec3& p : joint.mesh.vertices)
    if (std::abs(p.z()) < 1e-9 && std::max(std::abs(p.x()), std::abs(p.y())) < 10.1e-3)
      p.z() -= lift;
  return joint;
}

TEST(BodyShape, ALiftedSkinIsToldByVolumeAndHeight) {
  const TetMesh flat = raised(0).mesh;
  const SkinLift up = find_skin_lift(flat, raised(2e-3).mesh, Vec3(0, 0, 5e-3));
  EXPECT_NEAR(up.lifted, 22.5e-3 * 22.5e-3 * 2e-3, 0.03e-6);
  EXPECT_NEAR(up.net, up.lifted, 0.001e-6);
  EXPECT_NEAR(up.highest, 2e-3, 1e-9);
  EXPECT_LT(up.p_J.head<2>().cwiseAbs().maxCoeff(), 10.1e-3);
  const SkinLift down = find_skin_lift(raised(2e-3).mesh, flat, Vec3(0, 0, 5e-3));
  EXPECT_EQ(down.lifted, 0);
  EXPECT_NEAR(down.net, -up.net, 1e-15);
}

TEST(BodyShape, ASkinOfOtherTrianglesIsToldByVolumeAlone) {
  const SkinLift up = find_skin_lift(raised(0, 3).mesh, raised(2e-3).mesh, Vec3(0, 0, 5e-3));
  EXPECT_NEAR(up.lifted, 22.5e-3 * 22.5e-3 * 2e-3, 0.03e-6);
  EXPECT_EQ(up.highest, 0);
}

}  // namespace
}  // namespace artus
