// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/import/swept_tube.h"

#include <numbers>

#include <gmock/gmock.h>

#include <gtest/gtest.h>

#include "artus/anatomy/joint_file.h"
#include "artus/detail/anatomy/surfaces/defects.h"
#include "tests/anatomy/surfaces/surface_samples.h"

namespace artus {
namespace {

using testing::HasSubstr;
constexpr double kRadius = 2e-3;

TEST(SweptTube, AStraightOneIsACylinderWithRoundEnds) {
  const std::vector<Vec3> points{Vec3(0, 0, 0), Vec3(0.01, 0, 0), Vec3(0.04, 0, 0)};
  const auto tube = sweep_tube(points, kRadius, "t");
  ASSERT_TRUE(tube) << tube.error().to_string();
  EXPECT_TRUE(find_defects(*tube).empty());
  // A polygon of 16 sides holds 16 / 2 sin(2 pi / 16) / pi of its circle.
  const double polygon = 8 * std::sin(std::numbers::pi / 8) / std::numbers::pi;
  const double truth = std::numbers::pi * kRadius * kRadius * (0.04 + 4.0 / 3 * kRadius) * polygon;
  EXPECT_NEAR(signed_volume(*tube), truth, 0.01 * truth);
}

TEST(SweptTube, GoesThroughItsPointsAndKeepsItsRadiusRoundABend) {
  std::vector<Vec3> points;
  for (int k = 0; k <= 8; ++k)
    points.emplace_back(0.03 * std::cos(0.3 * k), 0.03 * std::sin(0.3 * k), 0.002 * k);
  const auto tube = sweep_tube(points, kRadius, "t");
  ASSERT_TRUE(tube);
  EXPECT_TRUE(find_defects(*tube).empty());
  for (const Vec3& p : points) {
    double least = 1;
    for (const Vec3& v : tube->vertices) least = std::min(least, (v - p).norm());
    EXPECT_NEAR(least, kRadius, 0.1 * kRadius);
  }
  for (const Vec3& v : tube->vertices)  // on the helix of that radius
    EXPECT_LT(std::abs(v.head<2>().norm() - 0.03), 1.2 * kRadius);
}

TEST(SweptTube, WhatCannotBeSweptIsRefusedWithWhyAndWhere) {
  const auto why = [](const std::vector<Vec3>& points, double radius) {
    const auto tube = sweep_tube(points, radius, "t");
    return tube ? std::string("none") : tube.error().message;
  };
  EXPECT_THAT(why({Vec3::Zero()}, kRadius), HasSubstr("two points"));
  EXPECT_THAT(why({Vec3::Zero(), Vec3::Zero()}, kRadius), HasSubstr("point 2"));
  EXPECT_THAT(why({Vec3::Zero(), Vec3(0.01, 0, 0)}, 0.05), HasSubstr("0.2 to 30 mm"));
  EXPECT_THAT(why({Vec3::Zero(), Vec3(0.01, 0, 0), Vec3(0, 0.001, 0)}, 3e-3),
              HasSubstr("bends more sharply"));
}

TEST(SweptTube, TubesOfAFileOfNamesAreStructuresOfTheirOwnAndAssumed) {
  const auto names = parse_structure_names(
      "[[tube]]\nname = \"Axillary nerve.r\"\ntissue = \"nerve\"\nradius = 1.5\n"
      "points = [[0.0, 0, 0], [10, 0, 0], [20, 5, 0]]\n",
      "names.toml");
  ASSERT_TRUE(names) << names.error().to_string();
  ImportedJoint joint;
  joint.name = "shoulder";
  joint.is_partition = true;
  ImportedStructure bone;
  bone.name = bone.source = "humerus";
  bone.tissue = "bone";
  joint.structures = {bone};
  ASSERT_TRUE(add_tubes(joint, names->tubes));
  EXPECT_EQ(joint.structures.front().name, "axillary_nerve");
  EXPECT_THAT(joint.assumed, testing::Contains(HasSubstr("a tube of 3 mm along 3 points")));
  const auto file = parse_joint(to_joint_toml(joint), "shoulder");
  ASSERT_TRUE(file) << file.error().to_string();
  EXPECT_EQ(file->structures[1].name, "axillary_nerve");  // behind the dermis
  EXPECT_EQ(file->structures[1].partition, "");
  EXPECT_EQ(file->structures[2].partition, "labels");
  EXPECT_FALSE(add_tubes(joint, names->tubes)) << "of that name there is one";
  const auto wrong = parse_structure_names(
      "[[tube]]\nname = \"n\"\ntissue = \"nerve\"\nradius = 1.5\npoints = [[0, 0]]\n",
      "names.toml");
  ASSERT_FALSE(wrong);
  EXPECT_THAT(wrong.error().message, HasSubstr("needs points"));
}

}  // namespace
}  // namespace artus
