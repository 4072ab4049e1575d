// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/body/holders.h"

#include <array>

#include <gtest/gtest.h>

#include "artus/detail/anatomy/body/meshed_block.h"
#include "tests/support/layered_body.h"

namespace artus {
namespace {

CompiledJoint block_of(const char* below) {
  const std::array<FlatLayer, 2> layers{{{"skin", 2e-3}, {below, 10e-3}}};
  return make_meshed_block(test::make_test_tissues(), layers, 24e-3, 24e-3, 4e-3);
}

TEST(Holders, AreBoneAndWhereTheBodyIsCut) {
  CompiledJoint block = block_of("muscle");
  EXPECT_FALSE(find_holders(block).any());
  EXPECT_EQ(describe(find_holders(block)), explain_unheld());
  stand_on_table(block);
  EXPECT_EQ(describe(find_holders(block)), "the tissue is held by the faces where the body is cut");
  CompiledJoint on_bone = block_of("bone");
  EXPECT_EQ(describe(find_holders(on_bone)), "the tissue is held by bone (bone)");
  stand_on_table(on_bone);
  EXPECT_EQ(describe(find_holders(on_bone)),
            "the tissue is held by bone (bone) and by the faces where the body is cut");
}

TEST(Holders, ABoneOfWhichNothingIsThereHoldsNothing) {
  CompiledJoint block = block_of("muscle");
  Region bone;
  bone.name = "femur";
  for (std::size_t i = 0; i < block.tissues.size(); ++i)
    if (block.tissues[i].haptic.hard) bone.tissue = static_cast<decltype(bone.tissue)>(i);
  block.regions.push_back(bone);
  EXPECT_FALSE(find_holders(block).any());
}

}  // namespace
}  // namespace artus
