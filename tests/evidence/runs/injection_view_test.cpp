// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/evidence/runs/injection_view.h"

#include <cmath>

#include <gtest/gtest.h>

#include "artus/detail/core/units.h"
#include "artus/detail/evidence/runs/injection_run.h"
#include "artus/detail/evidence/runs/probe_in_plane.h"
#include "tests/support/layered_body.h"

namespace artus {
namespace {

const std::vector<FlatLayer> kLayers{{"skin", 2e-3}, {"muscle", 25e-3}, {"bone", 8e-3}};
constexpr double kWidth = 38e-3;  // m of the face

TEST(FindView, HasTheNeedleInItsPlaneTheTipBeforeItsFaceAndTheFaceOnTheSkin) {
  const Scene scene(
      std::make_shared<const CompiledJoint>(test::make_layered_block(kLayers, 0.12, 0.12)));
  for (const Vec3& along : {Vec3(0.5, 0, 0.8), Vec3(0.8, 0.3, 0.4), Vec3(-0.2, -0.7, 0.6)})
    for (const double x : {-25e-3, 0.0, 35e-3}) {
      const Vec3 axis = along.normalized();
      const Pose X_JN = make_pose(Vec3(x, 10e-3, 15e-3), axis, Vec3::UnitY().cross(axis));
      const Pose X_JP = find_view_of(scene, X_JN, kWidth).X_JP;
      const Vec3 tip = X_JP.inverse() * X_JN.translation();
      EXPECT_NEAR(tip.y(), 0, 1e-6);
      EXPECT_GE(X_JP.linear().col(0).dot(scene.joint().X_JP_default.linear().col(0)), 0)
          << "left and right as in the joint's other pictures";
      EXPECT_NEAR((X_JP.linear().transpose() * axis).y(), 0, 1e-6);
      EXPECT_GT(tip.z(), 5e-3);
      EXPECT_LT(std::abs(tip.x()), kWidth / 2);
      for (const double at : {-0.8, 0.0, 0.8})
        EXPECT_LT(std::abs((X_JP * Vec3(at * kWidth / 2, 0, 0)).z()), 3e-3) << along.transpose();
    }
}

TEST(ProbeInPlane, HasTheNeedleInItsPlaneUnlessThatIsAlongTheBeam) {
  const Scene scene(
      std::make_shared<const CompiledJoint>(test::make_layered_block(kLayers, 0.12, 0.12)));
  const Pose& rest = scene.joint().X_JP_default;
  const Vec3 axis = Vec3(0.5, 0.4, 0.8).normalized();
  const Pose X_JP = probe_in_plane(scene, make_pose(Vec3(5e-3, 8e-3, 15e-3), axis, Vec3::UnitX()));
  EXPECT_NEAR((X_JP.linear().transpose() * axis).y(), 0, 1e-9);
  EXPECT_NEAR((X_JP.inverse() * Vec3(5e-3, 8e-3, 15e-3)).y(), 0, 1e-9);
  const Pose along = make_pose(Vec3(0, 0, 15e-3), rest.linear().col(2), rest.linear().col(0));
  EXPECT_TRUE(probe_in_plane(scene, along).isApprox(rest));
}

TEST(FindView, LooksBesideBoneThatLiesBeforeTheTip) {
  // The joint's own way of looking is through the bone, from below.
  CompiledJoint joint = test::make_layered_block(kLayers, 0.12, 0.12);
  joint.X_JP_default = make_pose(Vec3(0, 0, 35e-3), -Vec3::UnitZ(), Vec3::UnitX());
  const Scene scene(std::make_shared<const CompiledJoint>(std::move(joint)));
  const Vec3 axis = Vec3(0.6, 0, 0.8);
  const Pose X_JN = make_pose(Vec3(0, 0, 15e-3), axis, Vec3::UnitY().cross(axis));
  const Pose X_JP = find_view_of(scene, X_JN, kWidth).X_JP;
  EXPECT_LT(X_JP.translation().z(), 1e-3);
  EXPECT_GT(X_JP.linear().col(2).z(), 0.5);
}

TEST(FindView, NeverLooksFromWithinTheBody) {
  // Thicker than the longest way to a tip, and bone before the tip wherever one looks from outside.
  const std::vector<FlatLayer> layers{
      {"skin", 2e-3}, {"muscle", 8e-3}, {"bone", 5e-3}, {"muscle", 150e-3}};
  const Scene scene(
      std::make_shared<const CompiledJoint>(test::make_layered_block(layers, 0.2, 0.2)));
  const Vec3 axis = Vec3(0.6, 0, 0.8);
  const Pose X_JN = make_pose(Vec3(0, 0, 25e-3), axis, Vec3::UnitY().cross(axis));
  EXPECT_NEAR(find_view_of(scene, X_JN, kWidth).X_JP.translation().z(), 0, 3e-3);
}

TEST(RideOnSkin, AFaceLiesOnTheHighestSkinBelowItAndIsNeverPushedIn) {
  const Scene scene(
      std::make_shared<const CompiledJoint>(test::make_layered_block(kLayers, 0.12, 0.12)));
  const Vec3 down = Vec3::UnitZ();
  Transducer face;
  face.width = kWidth;
  const auto height = [&](double z, const Vec3& axis) {
    const Pose X_JP = make_pose(Vec3(0, 0, z), axis, Vec3::UnitY().cross(axis));
    return ride_on_skin(scene, X_JP, face).translation().z();
  };
  EXPECT_NEAR(height(5e-3, down), 0, 1e-6);
  EXPECT_EQ(height(-2e-3, down), -2e-3);
  const double tilt = 0.1;
  EXPECT_NEAR(height(0, Vec3(std::sin(tilt), 0, std::cos(tilt))), -kWidth / 2 * std::sin(tilt),
              1e-4)
      << "the edge that is in";
  face.radius = 30e-3;
  EXPECT_NEAR(height(0, Vec3(std::sin(tilt), 0, std::cos(tilt))), -30e-3 * (1 - std::cos(tilt)),
              3e-5)
      << "a round face rolls";
  EXPECT_NEAR(height(5e-3, down), 0, 1e-6);
}

/// Tetrahedra in which a target may lie, all over a layer of a block.
void fill_layer(CompiledJoint& joint, double z, RegionId region) {
  TetMesh& mesh = joint.mesh;
  for (int i = -2; i <= 2; ++i)
    for (int j = -2; j <= 2; ++j) {
      const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
      for (const Vec3& corner : {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)})
        mesh.vertices.emplace_back(Vec3(8e-3 * i, 8e-3 * j, z) + 1e-3 * corner);
      mesh.tetrahedra.push_back({first, first + 1, first + 2, first + 3});
      mesh.regions.push_back(region);
    }
}

/// Straight down is the shortest way, but a probe that has the needle in its plane then stands on
/// an edge.
TEST(FindLine, IsWhereAProbeSeesTheTip) {
  const std::vector<FlatLayer> layers{
      {"skin", 2e-3}, {"muscle", 15e-3}, {"bursa", 6e-3}, {"bone", 5e-3}};
  CompiledJoint block = test::make_layered_block(layers, 0.12, 0.12);
  fill_layer(block, 20e-3, kFirstRegion + 2);
  const Scene scene(std::make_shared<const CompiledJoint>(std::move(block)));
  const auto line = find_line_into(scene, kFirstRegion + 2);
  ASSERT_TRUE(line) << line.error().to_string();
  const auto& [entry, target] = *line;
  const Vec3 axis = (target - entry).normalized();
  EXPECT_EQ(scene.region_at(target), kFirstRegion + 2);
  EXPECT_NEAR(entry.z(), 0, 1e-6);
  EXPECT_GT(std::acos(axis.z()), 30 * kDegree);
  const FoundView view =
      find_view_of(scene, make_pose(target, axis, axis.unitOrthogonal()), kWidth);
  EXPECT_GT(view.merit, 2.8);
  EXPECT_LT((view.X_JP.inverse() * target).z(), 22e-3);
}

}  // namespace
}  // namespace artus
