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
#include "tests/anatomy/surfaces/surface_samples.h"
#ifdef ARTUS_HAS_DRACO
#include <draco/compression/expert_encode.h>
#include <draco/mesh/mesh.h>
#endif

namespace artus {
namespace {

using testing::HasSubstr;

std::string raw(const void* data, std::size_t n) {
  return {static_cast<const char*>(data), n};
}

std::string size_word(std::size_t n) {
  const auto word = static_cast<std::uint32_t>(n);
  return raw(&word, sizeof word);
}

/// Indices, then places, as glTF keeps them.
std::string plain_buffer(const SurfaceMesh& mesh) {
  std::string bytes;
  for (const Triangle& t : mesh.triangles) bytes += raw(t.data(), sizeof t);
  for (const Vec3& p : mesh.vertices) {
    const Eigen::Vector3f f = p.cast<float>();
    bytes += raw(f.data(), 12);
  }
  return bytes;
}

#ifdef ARTUS_HAS_DRACO
std::string draco_buffer(const SurfaceMesh& mesh) {
  draco::Mesh encoded;
  encoded.set_num_points(static_cast<std::uint32_t>(mesh.vertices.size()));
  draco::GeometryAttribute places;
  places.Init(draco::GeometryAttribute::POSITION, nullptr, 3, draco::DT_FLOAT32, false, 12, 0);
  const int id = encoded.AddAttribute(places, true, encoded.num_points());
  for (std::uint32_t i = 0; i < encoded.num_points(); ++i) {
    const Eigen::Vector3f f = mesh.vertices[i].cast<float>();
    encoded.attribute(id)->SetAttributeValue(draco::AttributeValueIndex(i), f.data());
  }
  for (const Triangle& t : mesh.triangles)
    encoded.AddFace({draco::PointIndex(t[0]), draco::PointIndex(t[1]), draco::PointIndex(t[2])});
  draco::ExpertEncoder encoder(encoded);
  encoder.SetAttributeQuantization(id, 18);
  draco::EncoderBuffer buffer;
  EXPECT_TRUE(encoder.EncodeToBuffer(&buffer).ok());
  return raw(buffer.data(), buffer.size());
}
#endif

struct GlbNode {
  std::string name;
  SurfaceMesh mesh;  ///< m, in the node's own frame
  Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();
  Vec3 shift = Vec3::Zero();
  double scale = 1;
};

/// What a file says of a mesh's indices and places.
std::string accessor_pair(const SurfaceMesh& mesh, const std::string& index_view,
                          const std::string& place_view) {
  Eigen::AlignedBox3d box;
  for (const Vec3& p : mesh.vertices) box.extend(p);
  return "{" + index_view +
         printed("\"componentType\":5125,\"count\":%zu,\"type\":\"SCALAR\"},{",
                 3 * mesh.triangles.size()) +
         place_view +
         printed(
             "\"componentType\":5126,\"count\":%zu,\"type\":\"VEC3\",\"min\":[%.9g,%.9g,"
             "%.9g],\"max\":[%.9g,%.9g,%.9g]}",
             mesh.vertices.size(), box.min().x(), box.min().y(), box.min().z(), box.max().x(),
             box.max().y(), box.max().z());
}

/// A binary glTF: one root node, which is turned and scaled, too, over nodes of a mesh each.
std::string to_glb(const GlbNode& root, const std::vector<GlbNode>& nodes, bool draco) {
  std::string views, accessors, meshes, list, children, binary;
  const auto place = [](const GlbNode& n) {
    return printed(
        "\"rotation\":[%.9g,%.9g,%.9g,%.9g],\"translation\":[%.9g,%.9g,%.9g],"
        "\"scale\":[%.9g,%.9g,%.9g]",
        n.turn.x(), n.turn.y(), n.turn.z(), n.turn.w(), n.shift.x(), n.shift.y(), n.shift.z(),
        n.scale, n.scale, n.scale);
  };
  const auto add_view = [&](std::size_t from, std::size_t size) {
    views += printed("%s{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":%zu}",
                     views.empty() ? "" : ",", from, size);
  };
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    const SurfaceMesh& mesh = nodes[k].mesh;
    const std::size_t start = binary.size();
    const std::size_t indices = 12 * mesh.triangles.size();
    std::string extension;
#ifdef ARTUS_HAS_DRACO
    if (draco) {
      binary += draco_buffer(mesh);
      add_view(start, binary.size() - start);
      extension = printed(
          ",\"extensions\":{\"KHR_draco_mesh_compression\":{\"bufferView\":%zu,"
          "\"attributes\":{\"POSITION\":0}}}",
          k);
    }
#endif
    if (!draco) {
      binary += plain_buffer(mesh);
      add_view(start, indices);
      add_view(start + indices, binary.size() - start - indices);
    }
    while (binary.size() % 4 != 0) binary += '\0';
    accessors +=
        (k > 0 ? "," : "") + accessor_pair(mesh, draco ? "" : printed("\"bufferView\":%zu,", 2 * k),
                                           draco ? "" : printed("\"bufferView\":%zu,", 2 * k + 1));
    meshes += printed("%s{\"primitives\":[{\"attributes\":{\"POSITION\":%zu},\"indices\":%zu%s}]}",
                      k > 0 ? "," : "", 2 * k + 1, 2 * k, extension.c_str());
    children += printed("%s%zu", k > 0 ? "," : "", k + 1);
    list += printed(",{\"name\":\"%s\",\"mesh\":%zu,", nodes[k].name.c_str(), k) + place(nodes[k]) +
            "}";
  }
  std::string json = "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],";
  if (draco)
    json +=
        "\"extensionsUsed\":[\"KHR_draco_mesh_compression\"],"
        "\"extensionsRequired\":[\"KHR_draco_mesh_compression\"],";
  json += "\"nodes\":[{\"name\":\"" + root.name + "\"," + place(root) + ",\"children\":[" +
          children + "]}" + list + "],\"meshes\":[" + meshes +
          "],\"buffers\":[{\"byteLength\":" + std::to_string(binary.size()) +
          "}],\"bufferViews\":[" + views + "],\"accessors\":[" + accessors + "]}";
  while (json.size() % 4 != 0) json += ' ';
  return "glTF" + size_word(2) + size_word(28 + json.size() + binary.size()) +
         size_word(json.size()) + "JSON" + json + size_word(binary.size()) +
         std::string("BIN\0", 4) + binary;
}

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
