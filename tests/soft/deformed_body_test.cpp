// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/soft/solver/deformed_body.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "tests/support/moved_block.h"

namespace artus {
namespace {

/// A block in a cage that is fine in its middle, coarse beside it.
struct GradedBlock {
  GradedBlock() {
    const std::array<test::FlatLayer, 2> layers{{{"skin", 6e-3}, {"muscle", 18e-3}}};
    joint = test::make_moved_block(layers).joint;
    SoftBlock block;
    block.half_x = block.half_y = 48e-3;
    block.layers = {{24e-3, linear_material(10e3, 0.47)}};
    const CageZone middle{Vec3(-12e-3, -12e-3, 0), Vec3(12e-3, 12e-3, 12e-3), 3e-3};
    map = make_body_map(*joint, Pose::Identity(), make_block_model(block, 6e-3, {middle}));
  }

  /// Moved along z by `near` and, from 30 mm beside the middle, by `far` on the side of +x.
  [[nodiscard]] std::shared_ptr<const DeformedBody> moved(
      double near, double far, const DeformedBody* before = nullptr) const {
    std::vector<Vec3> u;
    for (const Vec3& p : map->model->cage().nodes())
      u.emplace_back(0, 0, p.x() < 30e-3 ? near : far);
    return std::make_shared<const DeformedBody>(joint, map, u, ContactForce{}, before);
  }

  std::shared_ptr<const CompiledJoint> joint;
  std::shared_ptr<const BodyMap> map;
};

TEST(DeformedBody, GroupsFollowTheirOwnPointsInStepsOfTheirTolerance) {
  const GradedBlock block;
  std::set<double> tolerances;
  for (const VertexGroup& group : block.map->groups) tolerances.insert(group.tolerance);
  EXPECT_EQ(tolerances, (std::set<double>{0, 20e-6, 80e-6}));
  std::shared_ptr<const DeformedBody> body = block.moved(0, 0);
  std::size_t kept = 0;
  for (int i = 1; i <= 20; ++i) {
    const double near = 6e-6 * i;
    const double far = 100e-6 * i;
    body = block.moved(near, far, body.get());
    const auto vertices = body->vertices();
    for (const VertexGroup& group : block.map->groups) {
      const int steps = 1 + static_cast<int>(group.tolerance / 6e-6);
      const double held = 6e-6 * (i / steps * steps);
      const auto x_of = [&](std::uint32_t v) {
        return block.joint->mesh.vertices[v].x();
      };
      const double most = x_of(
          *std::max_element(group.vertices.begin(), group.vertices.end(),
                            [&](std::uint32_t a, std::uint32_t b) { return x_of(a) < x_of(b); }));
      for (const std::uint32_t v : group.vertices) {
        const double depth = vertices[v].z() - block.joint->mesh.vertices[v].z();
        if (x_of(v) > 31e-3) {
          ASSERT_NEAR(depth, far, 1e-9) << i;
        } else if (most < 23e-3) {
          ASSERT_NEAR(depth, held, 1e-9) << i;
          kept += held < near ? 1 : 0;
        }
      }
    }
  }
  EXPECT_GT(kept, 1000U);
}

TEST(DeformedBody, WhatStaysIsTheStateBefore) {
  const GradedBlock block;
  const auto before = block.moved(1e-3, 2e-3);
  const auto after = block.moved(1e-3 + 15e-6, 3e-3, before.get());
  const auto alone = block.moved(1e-3 + 15e-6, 3e-3);
  const auto now = after->vertices();
  const auto fresh = alone->vertices();
  std::size_t shared = 0;
  for (std::size_t g = 0; g < block.map->groups.size(); ++g) {
    if (after->groups()[g] == before->groups()[g]) {
      ++shared;
      EXPECT_GT(block.map->groups[g].tolerance, 15e-6);
      continue;
    }
    for (const std::uint32_t v : block.map->groups[g].vertices) ASSERT_EQ(now[v], fresh[v]);
  }
  EXPECT_GT(shared, block.map->groups.size() / 4);
  for (std::size_t v = 0; v < now.size(); ++v) ASSERT_LT((now[v] - fresh[v]).norm(), 40e-6);
}

}  // namespace
}  // namespace artus
