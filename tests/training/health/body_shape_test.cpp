// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/training/health/body_shape.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "artus/detail/soft/solver/soft_block.h"
#include "tests/support/meshed_block.h"

namespace artus {
namespace {

const std::vector<FlatLayer> kLayers{{"skin", 2e-3}, {"muscle", 10e-3}, {"bone", 4e-3}};

TEST(BodyShape, ATetrahedronTurnedOverIsFoundWithItsRegionAndPlace) {
  const TetMesh rest = test::make_meshed_block(kLayers, 20e-3, 20e-3, 2.5e-3).mesh;
  const LeastRatio same = find_least_ratio(rest, rest);
  EXPECT_TRUE(same.inverted.empty());
  EXPECT_GT(same.compared, rest.tetrahedra.size() / 2);
  EXPECT_NEAR(same.ratio, 1, 1e-9);

  TetMesh pushed = rest;
  const auto& tet = rest.tetrahedra[rest.tetrahedra.size() / 2];
  const Vec3 face = (rest.vertices[tet[0]] + rest.vertices[tet[1]] + rest.vertices[tet[2]]) / 3;
  pushed.vertices[tet[3]] += 2.5 * (face - rest.vertices[tet[3]]);
  const LeastRatio turned = find_least_ratio(rest, pushed);
  EXPECT_FALSE(turned.inverted.empty());
  EXPECT_LT(turned.ratio, -1);
  EXPECT_GE(turned.region, kFirstRegion);
  EXPECT_LT((turned.p_J - rest.vertices[tet[3]]).norm(), 6e-3);
}

/// Tetrahedra of 6 mm that lie askew in a cage of 3 mm.
struct AskewBlock {
  AskewBlock() {
    CompiledJoint askew = test::make_meshed_block(kThick, 36e-3, 36e-3, 6e-3);
    const Vec3 middle(0, 0, 12e-3);
    const Eigen::AngleAxisd turn(0.6, Vec3(1, 1, 0.3).normalized());
    for (Vec3& p : askew.mesh.vertices) p = middle + turn * (p - middle);
    joint = std::make_shared<const CompiledJoint>(std::move(askew));
    SoftBlock block;
    block.half_x = block.half_y = 48e-3;
    block.layers = {{24e-3, linear_material(10e3, 0.47)}};
    map = make_body_map(*joint, Pose::Identity(), make_block_model(block, 3e-3, {}));
  }

  /// Inverted tetrahedra, and those whose tissue is, where a node at p moves by `u(p)` along z.
  template <class U>
  [[nodiscard]] std::array<std::size_t, 2> count(U u) const {
    std::vector<Vec3> nodes;
    for (const Vec3& p : map->model->cage().nodes()) nodes.emplace_back(0, 0, u(p));
    const DeformedBody body(joint, map, nodes, ContactForce{});
    const LeastRatio least = find_least_ratio(joint->mesh, body.moved_joint().mesh);
    std::size_t tissue = 0;
    for (const std::size_t i : least.inverted) tissue += is_tissue_inverted(body, i) ? 1 : 0;
    return {least.inverted.size(), tissue};
  }

  const std::vector<FlatLayer> kThick{{"skin", 6e-3}, {"muscle", 18e-3}};
  std::shared_ptr<const CompiledJoint> joint;
  std::shared_ptr<const BodyMap> map;
};

TEST(BodyShape, CornersThatChangeSidesAreNoFoldOfTheTissueBetweenThem) {
  const AskewBlock block;
  // Columns slide along each other: no volume changes anywhere, whatever corners far apart do.
  const auto slid =
      block.count([](const Vec3& p) { return std::lround(p.x() / 3e-3) % 2 == 0 ? 0.0 : 6e-3; });
  EXPECT_GT(slid[0], 0U);
  EXPECT_EQ(slid[1], 0U);
  const auto folded =
      block.count([](const Vec3& p) { return -1.5 * std::max(0.0, p.z() - 12e-3); });
  EXPECT_GT(folded[0], 0U);
  EXPECT_EQ(folded[1], folded[0]);
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

TEST(BodyShape, ASkinIsTheSameWhateverLiquidCutsBelow) {
  CompiledJoint cut = raised(2e-3);
  auto& all = cut.mesh.interfaces;
  const auto inner = std::find_if(all.begin(), all.end(), [](const Interface& f) {
    return f.front != kOutside && f.back != kOutside;
  });
  ASSERT_NE(inner, all.end());
  all.insert(all.begin(), *inner);
  EXPECT_NEAR(find_skin_lift(raised(0).mesh, cut.mesh, Vec3(0, 0, 5e-3)).highest, 2e-3, 1e-9);
}

TEST(BodyShape, ASkinOfOtherTrianglesIsToldByVolumeAlone) {
  const SkinLift up = find_skin_lift(raised(0, 3).mesh, raised(2e-3).mesh, Vec3(0, 0, 5e-3));
  EXPECT_NEAR(up.lifted, 22.5e-3 * 22.5e-3 * 2e-3, 0.03e-6);
  EXPECT_EQ(up.highest, 0);
}

}  // namespace
}  // namespace artus
