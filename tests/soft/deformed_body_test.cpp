// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/soft/deformed_body.h"

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

  [[nodiscard]] double depth(const DeformedBody& body, std::size_t k) const {
    const std::uint32_t v = map->moving[k];
    return body.vertices()[v].z() - joint->mesh.vertices[v].z();
  }

  std::shared_ptr<const CompiledJoint> joint;
  std::shared_ptr<const BodyMap> map;
};

TEST(DeformedBody, FarVerticesFollowTheirOwnCubesNodesInStepsOfTwentyMicrometres) {
  const GradedBlock block;
  ASSERT_GT(block.map->n_near, 100U);
  ASSERT_GT(block.map->moving.size(), block.map->n_near + 100);
  std::shared_ptr<const DeformedBody> body = block.moved(0, 0);
  std::size_t kept = 0;
  for (int i = 1; i <= 12; ++i) {
    const double near = 5e-6 * i;
    const double far = 50e-6 * i;
    body = block.moved(near, far, body.get());
    const double held = 5e-6 * (i / 5 * 5);  // 20 um are not more than 20 um
    for (std::size_t k = 0; k < block.map->moving.size(); ++k) {
      const double x = block.joint->mesh.vertices[block.map->moving[k]].x();
      const double depth = block.depth(*body, k);
      if (k < block.map->n_near) {
        ASSERT_NEAR(depth, near, 1e-9);
      } else if (x < 23e-3) {
        ASSERT_NEAR(depth, held, 1e-9) << i;
        ++kept;
      } else if (x > 31e-3) {
        ASSERT_NEAR(depth, far, 1e-9) << i;
      }
    }
  }
  EXPECT_GT(kept, 1000U);
}

TEST(DeformedBody, WhatStaysHasTheBytesOfTheStateBefore) {
  const GradedBlock block;
  const auto before = block.moved(1e-3, 2e-3);
  const auto after = block.moved(1e-3 + 15e-6, 3e-3, before.get());
  const auto alone = block.moved(1e-3 + 15e-6, 3e-3);
  for (std::size_t k = block.map->n_near; k < block.map->moving.size(); ++k) {
    const std::uint32_t v = block.map->moving[k];
    const double x = block.joint->mesh.vertices[v].x();
    const bool still = after->vertices()[v] == before->vertices()[v];
    const bool there = after->vertices()[v] == alone->vertices()[v];
    ASSERT_TRUE(x > 23e-3 || still);
    ASSERT_TRUE(x < 31e-3 || there);
    ASSERT_LT((after->vertices()[v] - alone->vertices()[v]).norm(), 20e-6);
  }
}

}  // namespace
}  // namespace artus
