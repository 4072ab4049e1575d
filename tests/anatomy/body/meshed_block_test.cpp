// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/body/meshed_block.h"

#include <array>
#include <map>
#include <utility>

#include <gtest/gtest.h>

#include "tests/support/layered_body.h"

namespace artus {
namespace {

constexpr double kEdge = 24e-3;  // m, of the block seen from above

CompiledJoint make_two_layers() {
  const std::array<FlatLayer, 2> layers{{{"skin", 2e-3}, {"muscle", 10e-3}}};
  return make_meshed_block(test::make_test_tissues(), layers, kEdge, kEdge, 4e-3);
}

TEST(MeshedBlock, TetrahedraFillEachLayer) {
  const CompiledJoint joint = make_two_layers();
  std::map<RegionId, double> volume;
  for (std::size_t t = 0; t < joint.mesh.tetrahedra.size(); ++t) {
    EXPECT_GT(tet_volume(joint.mesh, t), 0) << t;
    volume[joint.mesh.regions[t]] += tet_volume(joint.mesh, t);
  }
  ASSERT_EQ(volume.size(), 2U);
  EXPECT_NEAR(volume[region_named(joint, "skin")], kEdge * kEdge * 2e-3, 1e-15);
  EXPECT_NEAR(volume[region_named(joint, "muscle")], kEdge * kEdge * 10e-3, 1e-15);
}

TEST(MeshedBlock, InterfacesCloseEachLayer) {
  const CompiledJoint joint = make_two_layers();
  std::map<std::pair<RegionId, RegionId>, double> area;
  std::map<RegionId, Vec3> sum;  // of a closed surface's areas as vectors: none
  for (const Interface& face : joint.mesh.interfaces) {
    const Vec3& a = joint.mesh.vertices[face.vertices[0]];
    const Vec3 normal = 0.5 * (joint.mesh.vertices[face.vertices[1]] - a)
                                  .cross(joint.mesh.vertices[face.vertices[2]] - a);
    area[std::minmax(face.front, face.back)] += normal.norm();
    sum.try_emplace(face.front, Vec3::Zero()).first->second -= normal;
    sum.try_emplace(face.back, Vec3::Zero()).first->second += normal;
  }
  const RegionId skin = region_named(joint, "skin");
  const RegionId muscle = region_named(joint, "muscle");
  EXPECT_NEAR((area[std::minmax(skin, muscle)]), kEdge * kEdge, 1e-12);
  EXPECT_NEAR((area[std::minmax(kOutside, skin)]), kEdge * (kEdge + 4 * 2e-3), 1e-12);
  for (const auto& [region, normals] : sum) EXPECT_NEAR(normals.norm(), 0, 1e-12) << region;
}

}  // namespace
}  // namespace artus
