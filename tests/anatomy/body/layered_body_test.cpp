// SPDX-License-Identifier: AGPL-3.0-or-later
// The small bodies that echography and the tests measure themselves against.
#include "artus/detail/anatomy/body/layered_body.h"

#include <array>
#include <map>
#include <numbers>
#include <tuple>

#include <gtest/gtest.h>

#include "artus/detail/anatomy/body/find_region.h"
#include "artus/detail/anatomy/body/joint_digest.h"
#include "tests/support/layered_body.h"

namespace artus {
namespace {

/// Volume enclosed by all interfaces between `region` and anything else, m^3.
double volume_of(const CompiledJoint& joint, RegionId region) {
  double volume = 0;
  for (const Interface& f : joint.mesh.interfaces) {
    const auto& v = joint.mesh.vertices;
    const double share = v[f.vertices[0]].dot(v[f.vertices[1]].cross(v[f.vertices[2]])) / 6;
    if (f.back == region) volume += share;
    if (f.front == region) volume -= share;
  }
  return volume;
}

/// Every edge of a region's hull is run both ways, so nothing leaks.
void expect_closed(const CompiledJoint& joint) {
  for (RegionId region = kFirstRegion; region < joint.regions.size(); ++region) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> balance;
    for (const Interface& f : joint.mesh.interfaces) {
      const int sign = f.back == region ? 1 : (f.front == region ? -1 : 0);
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t a = f.vertices[k];
        const std::uint32_t b = f.vertices[(k + 1) % 3];
        balance[{std::min(a, b), std::max(a, b)}] += a < b ? sign : -sign;
      }
    }
    for (const auto& [edge, sum] : balance) ASSERT_EQ(sum, 0);
  }
}

TEST(LayeredBlock, HasTheVolumesOfItsLayersAndNamesThemByTissue) {
  const std::array<FlatLayer, 3> layers{{{"skin", 2e-3}, {"fat", 5e-3}, {"skin", 3e-3}}};
  const CompiledJoint joint = test::make_layered_block(layers, 0.1, 0.05, Vec3(0.01, 0, 0.02));
  EXPECT_NEAR(volume_of(joint, region_named(joint, "skin")), 2e-3 * 5e-3, 1e-15);
  EXPECT_NEAR(volume_of(joint, region_named(joint, "fat")), 5e-3 * 5e-3, 1e-15);
  EXPECT_NEAR(volume_of(joint, region_named(joint, "skin_2")), 3e-3 * 5e-3, 1e-15);
  EXPECT_EQ(joint.tissue_of(region_named(joint, "skin_2")).name, "skin");
  EXPECT_EQ(joint.X_JP_default.translation(), Vec3(0.01, 0, 0.02));
  expect_closed(joint);
}

TEST(NestedSpheres, HaveNearlyTheVolumesOfTheirShellsFromBelow) {
  const std::array<SphereLayer, 2> layers{{{"fat", 0.03}, {"bone", 0.01}}};
  const CompiledJoint joint = test::make_nested_spheres(layers, Vec3(0.1, 0, 0));
  const double outer = 4.0 / 3 * std::numbers::pi * std::pow(0.03, 3);
  const double inner = 4.0 / 3 * std::numbers::pi * std::pow(0.01, 3);
  EXPECT_NEAR(volume_of(joint, region_named(joint, "bone")), inner, 0.004 * inner);
  EXPECT_LT(volume_of(joint, region_named(joint, "bone")), inner);
  EXPECT_NEAR(volume_of(joint, region_named(joint, "fat")), outer - inner, 0.004 * outer);
  expect_closed(joint);
}

TEST(AddBall, IsARegionOfItsOwnInItsLayer) {
  const std::array<FlatLayer, 2> layers{{{"fat", 10e-3}, {"muscle", 30e-3}}};
  CompiledJoint joint = test::make_layered_block(layers, 0.1, 0.1);
  add_ball(joint, {"bursa", Vec3(5e-3, 0, 25e-3), 4e-3}, region_named(joint, "muscle"));
  add_ball(joint, {"fat", Vec3(-15e-3, 0, 25e-3), 6e-3}, region_named(joint, "muscle"));
  for (const auto& [name, centre, radius] : {std::tuple{"bursa", Vec3(5e-3, 0, 25e-3), 4e-3},
                                             std::tuple{"fat_2", Vec3(-15e-3, 0, 25e-3), 6e-3}}) {
    const RegionId region = region_named(joint, name);
    int n = 0;
    for (const Interface& face : joint.mesh.interfaces) {
      if (face.back != region) continue;
      ++n;
      EXPECT_EQ(face.front, region_named(joint, "muscle"));
      for (const std::uint32_t v : face.vertices)
        EXPECT_NEAR((joint.mesh.vertices[v] - centre).norm(), radius, 1e-12);
    }
    EXPECT_EQ(n, 20 * 64) << name;
  }
}

TEST(BlockWithSphere, HoldsItsInclusion) {
  const CompiledJoint joint = test::make_block_with_sphere(
      {"muscle", Vec3(0.1, 0.08, 0.06), Vec3::Zero(), "bone", Vec3(0, 0, 0.03), 0.02});
  const double ball = 4.0 / 3 * std::numbers::pi * std::pow(0.02, 3);
  const double whole = 0.1 * 0.08 * 0.06;
  EXPECT_NEAR(volume_of(joint, region_named(joint, "inclusion")), ball, 0.004 * ball);
  EXPECT_NEAR(volume_of(joint, region_named(joint, "block")), whole - ball, 0.004 * ball);
  EXPECT_EQ(joint.tissue_of(region_named(joint, "inclusion")).name, "bone");
  expect_closed(joint);
}

TEST(LayeredBodies, ATissueThatIsNotThereIsTheCallersMistake) {
  const std::array<FlatLayer, 1> layers{{{"unobtainium", 2e-3}}};
  EXPECT_THROW(static_cast<void>(test::make_layered_block(layers, 1, 1)), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(region_named(CompiledJoint{}, "fat")), std::invalid_argument);
}

TEST(TransformedBody, KeepsVolumesAndTurnsAllThatHasADirection) {
  const std::array<FlatLayer, 1> layers{{{"muscle", 0.02}}};
  CompiledJoint joint = test::make_layered_block(layers, 0.1, 0.05);
  joint.regions.back().fibre_axis = Vec3::UnitX();
  joint.landmarks.push_back({"here", Vec3(0.01, 0.02, 0.03)});
  const Pose X = make_pose(Vec3(1, 2, 3), Vec3(1, 1, 0), Vec3::UnitZ());
  const CompiledJoint moved = transformed(joint, X);
  EXPECT_NEAR(volume_of(moved, kFirstRegion), volume_of(joint, kFirstRegion), 1e-12);
  EXPECT_TRUE(moved.regions.back().fibre_axis.isApprox(X.linear() * Vec3::UnitX()));
  EXPECT_TRUE(moved.landmarks[0].position.isApprox(X * joint.landmarks[0].position));
  EXPECT_TRUE(moved.X_JP_default.isApprox(X * joint.X_JP_default));
  EXPECT_TRUE(moved.injections[0].target.isApprox(X * joint.injections[0].target));
}

TEST(FindRegion, FindsStructuresAndRefusesWhatIsNoneWithTheNamesThereAre) {
  const std::array<FlatLayer, 2> layers{{{"skin", 1e-3}, {"fat", 2e-3}}};
  const CompiledJoint joint = test::make_layered_block(layers, 0.01, 0.01);
  const auto fat = find_region(joint, "fat");
  ASSERT_TRUE(fat);
  EXPECT_EQ(joint.regions[*fat].name, "fat");
  const auto outside = find_region(joint, joint.regions[kOutside].name);
  ASSERT_FALSE(outside);
  EXPECT_EQ(outside.error().code, ErrorCode::not_found);
  EXPECT_NE(outside.error().message.find("fat"), std::string::npos);
}

TEST(TetVolume, IsPositiveForAPositiveTetrahedronAndChangesSignWithTheOrder) {
  TetMesh mesh;
  mesh.vertices = {Vec3::Zero(), Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()};
  mesh.tetrahedra = {{0, 1, 2, 3}, {1, 0, 2, 3}};
  EXPECT_DOUBLE_EQ(tet_volume(mesh, 0), 1.0 / 6);
  EXPECT_DOUBLE_EQ(tet_volume(mesh, 1), -1.0 / 6);
}

TEST(JointDigest, IsTheSameForTheSameBodyAndAnotherForAnyOther) {
  const auto tissues = read_bundled_tissues();
  ASSERT_TRUE(tissues);
  const std::vector<SphereLayer> layers{{"skin", 0.02}, {"bone", 0.01}};
  const CompiledJoint joint = make_nested_spheres(*tissues, layers, Vec3::Zero(), 1);
  EXPECT_EQ(compute_joint_digest(joint), compute_joint_digest(CompiledJoint(joint)));
  EXPECT_EQ(compute_joint_digest(joint).size(), 16U);
  CompiledJoint other = joint;
  other.tissues.back().haptic.friction += 1e-9;
  EXPECT_NE(compute_joint_digest(other), compute_joint_digest(joint));
  other = joint;
  other.mesh.vertices.back().x() += 1e-9;
  EXPECT_NE(compute_joint_digest(other), compute_joint_digest(joint));
}

}  // namespace
}  // namespace artus
