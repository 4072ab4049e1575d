// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/evidence/validation/soft/soft_gates.h"

#include <array>
#include <memory>
#include <utility>

#include <gtest/gtest.h>

#include "artus/detail/evidence/validation/gates.h"
#include "tests/support/meshed_block.h"

namespace artus {
namespace {

class SoftGates : public testing::TestWithParam<const char*> {};

TEST_P(SoftGates, Hold) {
  const auto gate = run_gate("soft", GetParam());
  ASSERT_TRUE(gate);
  EXPECT_FALSE(gate->claims.empty());
  for (const Claim& claim : gate->claims) EXPECT_TRUE(claim.pass) << to_line(claim);
}

// Without "point-force", whose nearest point on the surface is out of its bound
// (docs/deformation.md), and those that tests/soft measures in another form.
INSTANTIATE_TEST_SUITE_P(All, SoftGates,
                         testing::Values("patch", "uniaxial", "cantilever", "punch", "layers",
                                         "volume", "turned", "still"));

std::shared_ptr<const CompiledJoint> make_limb() {
  const std::array<FlatLayer, 4> layers{
      {{"skin", 2e-3}, {"fat", 8e-3}, {"muscle", 20e-3}, {"bone", 10e-3}}};
  return std::make_shared<const CompiledJoint>(test::make_meshed_block(layers, 64e-3, 48e-3, 4e-3));
}

GateOptions of_joint(std::shared_ptr<const CompiledJoint> joint) {
  GateOptions options;
  options.joint = std::move(joint);
  return options;
}

/// H1 of muscle is out of its bound (docs/deformation.md).
TEST(SoftGatesOfAJoint, ALimbIsPressedAsAJoint) {
  const auto gate = run_gate("soft", "joint-pressed", of_joint(make_limb()));
  ASSERT_TRUE(gate) << gate.error().to_string();
  EXPECT_EQ(gate->claims.size(), 5U);
  for (const Claim& claim : gate->claims)
    EXPECT_TRUE(claim.pass || claim.text.rfind("H1: muscle", 0) == 0) << to_line(claim);
}

TEST(SoftGatesOfAJoint, AJointThatCannotGiveWayFailsItsGates) {
  CompiledJoint rigid = *make_limb();
  rigid.mesh = {};
  const auto joint = std::make_shared<const CompiledJoint>(std::move(rigid));
  for (const char* name : {"joint-pressed", "joint-still"}) {
    const auto gate = run_gate("soft", name, of_joint(joint));
    ASSERT_TRUE(gate);
    EXPECT_FALSE(all_hold(gate->claims)) << name;
  }
}

}  // namespace
}  // namespace artus
