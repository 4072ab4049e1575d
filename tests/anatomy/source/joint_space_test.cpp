// SPDX-License-Identifier: AGPL-3.0-or-later
#include <gmock/gmock.h>

#include "artus/anatomy/joint_file.h"
#include "artus/detail/anatomy/source/joint_space_toml.h"

namespace artus {
namespace {

using testing::HasSubstr;

const std::string kSpacesElbow =
    "format = 1\nname = \"elbow\"\nunits = \"mm\"\naxes = \"LPS\"\n"
    "[body]\nfile = \"body.stl\"\ntissue = \"fat\"\n"
    "[[structure]]\nname = \"ulna\"\ntissue = \"bone\"\nfile = \"ulna.stl\"\n"
    "[[structure]]\nname = \"recess\"\ntissue = \"synovial_fluid\"\nfile = \"recess.stl\"\n";

std::string refusal(const std::string& text) {
  const auto joint = parse_joint(kSpacesElbow + text, "j");
  return joint ? "" : joint.error().to_string();
}

TEST(JointSpaces, AJointsOwnStandOnAProfileAndOverrideIt) {
  const auto joint = parse_joint(kSpacesElbow +
                                     "[[space]]\nname = \"cavity\"\nregions = [\"recess\"]\n"
                                     "like = \"capsulitis_man\"\nrupture_ml = 30\n",
                                 "j");
  ASSERT_TRUE(joint) << joint.error().to_string();
  ASSERT_EQ(joint->spaces.size(), 1U);
  EXPECT_NEAR(joint->spaces[0].law.rupture, 30e-6, 1e-15);
  EXPECT_NEAR(joint->spaces[0].law.stiffness, 2.66644e9, 1);
}

TEST(JointSpaces, OneThatJoinsTakesInThoseThatShareARegionOrItsName) {
  const std::string first =
      "[[space]]\nname = \"cavity\"\nregions = [\"recess\"]\nlike = \"joint\"\n";
  const std::string second =
      "[[space]]\nname = \"whole\"\nregions = [\"ulna\", \"recess\"]\nlike = \"bursa\"\n";
  EXPECT_THAT(refusal(first + second), HasSubstr("is in a space already"));
  const auto joint = parse_joint(kSpacesElbow + first + second + "joins = true\n", "j");
  ASSERT_TRUE(joint) << joint.error().to_string();
  ASSERT_EQ(joint->spaces.size(), 1U);
  EXPECT_EQ(joint->spaces[0].name, "whole");
  EXPECT_THAT(joint->spaces[0].regions, testing::UnorderedElementsAre("ulna", "recess"));
  const auto last = parse_joint(
      kSpacesElbow + first +
          "[[space]]\nname = \"cavity\"\nregions = [\"ulna\"]\nlike = \"bursa\"\njoins = true\n",
      "j");
  ASSERT_TRUE(last) << last.error().to_string();
  EXPECT_THAT(last->spaces[0].regions, testing::UnorderedElementsAre("ulna", "recess"));
}

TEST(JointSpaces, AreRefusedWithWhatIsWrongAndWhatThereIs) {
  const std::string head = "[[space]]\nname = \"s\"\nlike = \"joint\"\n";
  EXPECT_THAT(refusal(head + "regions = [\"reces\"]\n"), HasSubstr("did you mean 'recess'"));
  EXPECT_THAT(refusal("[[space]]\nname = \"s\"\nlike = \"joynt\"\nregions = [\"recess\"]\n"),
              HasSubstr("did you mean 'joint'"));
  EXPECT_THAT(refusal(head + "regions = [\"recess\"]\nleaks_to = \"nowhere\"\n"),
              HasSubstr("which is not a space"));
  EXPECT_THAT(refusal(head + "regions = [\"recess\"]\nyield_ml = 50\n"), HasSubstr("rupture_ml"));
  EXPECT_THAT(refusal(head + "regions = [\"recess\"]\n" + head + "regions = [\"recess\"]\n"),
              HasSubstr("in a space already"));
  EXPECT_THAT(refusal("[[space]]\nname = \"s\"\nregions = [\"recess\"]\n"), HasSubstr("law"));
  EXPECT_THAT(refusal(head + "regions = [\"recess\"]\nstiffness_kpa_ml = nan\n"),
              HasSubstr("stiffness_kpa_ml"));
}

TEST(JointSpaces, AFileThatNamesNoneHasNone) {
  Problems problems;
  const auto table = parse_toml("", "empty");
  TomlTable none(*table, "joint", problems);
  EXPECT_TRUE(read_spaces(none, {})->empty());
}

}  // namespace
}  // namespace artus
