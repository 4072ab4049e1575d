// SPDX-License-Identifier: AGPL-3.0-or-later
// A scene as atlases publish it: 25 structures in nodes within nodes, metres, turned, y up, plain
// and compressed by Draco.
#include <cstring>

#include <gmock/gmock.h>

#include <gtest/gtest.h>

#include "artus/detail/anatomy/import/draco_scene.h"
#include "artus/detail/anatomy/import/scene_parts.h"
#include "artus/detail/anatomy/import/scene_reader.h"
#include "artus/detail/core/printed.h"
#include "tests/anatomy/import/glb_samples.h"
#include "tests/anatomy/surfaces/surface_samples.h"

namespace artus {
namespace {

using test::GlbNode;
using test::to_glb;
using testing::HasSubstr;

/// 25 tubes and balls, each in a node of its own place, turn and scale.
std::vector<GlbNode> atlas() {
  std::vector<GlbNode> nodes;
  for (int k = 0; k < 25; ++k) {
    GlbNode node;
    node.name = printed("Muscle %02d.r", k);
    node.mesh = k % 2 == 0 ? make_sphere(Vec3(0.1, 0, 0), 0.02) : make_tube(16, 9, 0.01, 0.08);
    const double t = k;
    node.turn = Eigen::Quaterniond(std::cos(t), std::sin(2 * t), std::cos(3 * t), 0.3).normalized();
    node.shift = Vec3(0.3 * std::sin(t), 0.9 + 0.02 * t, 0.2 * std::cos(t));
    node.scale = 0.8 + 0.02 * t;
    nodes.push_back(std::move(node));
  }
  return nodes;
}

GlbNode root_node() {
  GlbNode root;
  root.name = "Root";
  root.turn = Eigen::Quaterniond(0.7, 0.1, -0.5, 0.2).normalized();
  root.shift = Vec3(0.4, -1.1, 0.05);
  root.scale = 1.1;
  return root;
}

/// Where a point of a node stands in LPS: (x, -z, y) of the scene.
Vec3 in_lps(const GlbNode& root, const GlbNode& node, const Vec3& p) {
  const Vec3 in_root = node.turn * (node.scale * p) + node.shift;
  const Vec3 q = root.turn * (root.scale * in_root) + root.shift;
  return {q.x(), -q.z(), q.y()};
}

class SceneFile : public testing::TestWithParam<bool> {};

TEST_P(SceneFile, TwentyFiveNodesLandWithinAHundredthOfAMillimetre) {
  if (!reads_scenes()) GTEST_SKIP() << "built without libassimp";
#ifndef ARTUS_HAS_DRACO
  if (GetParam()) GTEST_SKIP() << "there is no libdraco-dev to write the scene with";
#endif
  const auto nodes = atlas();
  const GlbNode root = root_node();
  const auto parts = read_scene(to_glb(root, nodes, GetParam()), "atlas.glb", 1e-3);
  ASSERT_TRUE(parts) << parts.error().to_string();
  ASSERT_EQ(parts->size(), nodes.size());
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    const ScenePart& part = (*parts)[k];
    EXPECT_EQ(part.name, nodes[k].name);
    ASSERT_EQ(part.mesh.vertices.size(), nodes[k].mesh.vertices.size());
    ASSERT_EQ(part.mesh.triangles.size(), nodes[k].mesh.triangles.size());
    double farthest = 0;
    for (const Vec3& p : nodes[k].mesh.vertices) {
      const Vec3 truth = in_lps(root, nodes[k], p);
      double least = 1;
      for (const Vec3& q : part.mesh.vertices) least = std::min(least, (q - truth).norm());
      farthest = std::max(farthest, least);
    }
    EXPECT_LT(farthest, 0.01e-3) << part.name;
    const double volume = std::pow(root.scale * nodes[k].scale, 3) * signed_volume(nodes[k].mesh);
    EXPECT_NEAR(signed_volume(part.mesh), volume, 1e-3 * volume) << part.name;
  }
}
INSTANTIATE_TEST_SUITE_P(PlainAndDraco, SceneFile, testing::Bool());

TEST(SceneFiles, WhatIsNotCompressedIsLeftAsItIsAndDamageIsTold) {
  const std::vector<GlbNode> one{atlas().front()};
  const std::string plain = to_glb(root_node(), one, false);
  EXPECT_EQ(*expand_draco(plain, "a.glb"), plain);
  EXPECT_EQ(*expand_draco("solid", "a.stl"), "solid");
#ifdef ARTUS_HAS_DRACO
  const std::string bytes = to_glb(root_node(), one, true);
  EXPECT_EQ(expand_draco(bytes, "a.glb")->find("KHR_draco"), std::string::npos);
  std::string damaged = bytes;
  damaged.resize(damaged.size() - 200);
  const auto refused = expand_draco(damaged, "a.glb");
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr("export it without compression"));
#endif
}

TEST(SceneFiles, AnOpenPatchIsRefusedWithTheWayOut) {
  if (!reads_scenes()) GTEST_SKIP() << "built without libassimp";
  auto nodes = atlas();
  nodes.resize(3);
  nodes[1].name = "Ligament patch.r";
  nodes[1].mesh = make_cube(Vec3::Zero(), 0.01);
  nodes[1].mesh.triangles.resize(4);
  auto parts = read_scene(to_glb(root_node(), nodes, false), "atlas.glb", 1e-3);
  ASSERT_TRUE(parts) << parts.error().to_string();
  const auto joint = import_parts(std::move(*parts), {}, "atlas.glb", {});
  ASSERT_TRUE(joint) << joint.error().to_string();
  EXPECT_EQ(joint->structures.size(), 2U);
  ASSERT_EQ(joint->left_out.size(), 1U);
  EXPECT_EQ(joint->left_out[0].source, "Ligament patch.r");
  EXPECT_THAT(joint->left_out[0].by, HasSubstr("thicken"));
  EXPECT_THAT(joint->left_out[0].by, HasSubstr("landmark"));
}

}  // namespace
}  // namespace artus
