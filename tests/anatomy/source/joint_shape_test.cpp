// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/source/joint_shape.h"

#include <gtest/gtest.h>

namespace artus {
namespace {

std::string shape(const std::string& toml) {
  return to_joint_shape(parse_toml(toml, "t").value());
}

constexpr const char* kShape = R"(name = "knee"
[mesh]
facet_size = 3.0
[[structure]]
name = "femur"
tissue = "bone"
file = "femur.ply"
)";

TEST(JointShape, LeavesOutCommentsOrderAndWhatShapesNothing) {
  EXPECT_EQ(shape(kShape), shape(R"(# A knee.
name = "knee"
title = "A knee"
side = "left"
axes = "RAS"
[probe]
position = [1.0, 2.0, 3.0]
[[structure]]
file = "femur.ply"
fibre_axis = [0.0, 0.0, 1.0]
fibre_course = "layer"
tissue = "bone"
name = "femur"
[mesh]
facet_size = 3.0
[[injection]]
name = "one"
)"));
}

TEST(JointShape, HoldsEverythingElseAlsoWhatItDoesNotKnow) {
  const std::string base = shape(kShape);
  EXPECT_NE(shape(std::string(kShape) + "facet_size = 1.0\n"), base);
  EXPECT_NE(shape(std::string(kShape) + "some_later_key = 1\n"), base);
}

}  // namespace
}  // namespace artus
