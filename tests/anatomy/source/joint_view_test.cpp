// SPDX-License-Identifier: AGPL-3.0-or-later
#include <string>

#include <gmock/gmock.h>

#include "artus/anatomy/joint_file.h"
#include "artus/detail/anatomy/source/joint_view_toml.h"

namespace artus {
namespace {

using testing::HasSubstr;

const std::string kViewedArm =
    "format = 1\nname = \"elbow\"\nunits = \"mm\"\naxes = \"LPS\"\n"
    "[body]\nfile = \"body.stl\"\ntissue = \"fat\"\n"
    "[[structure]]\nname = \"ulna\"\ntissue = \"bone\"\nfile = \"ulna.stl\"\n"
    "[pose.bent]\n";
const std::string kViewSaid =
    "[view.front]\ntitle = \"front\"\nsource = \"[A2000]\"\nshows = \"bone\"\n";
const std::string kViewStands =
    "[view.front.probe]\nposition = [1, 2, 3]\ndirection = [0, 0, 1]\nlateral = [1, 0, 0]\n";
const std::string kViewSees = "[[view.front.see]]\nstructure = \"ulna\"\ndepth = [3, 9]\n";

std::string refused_view(const std::string& view) {
  const auto joint = parse_joint(kViewedArm + view, "j");
  return joint ? "" : joint.error().to_string();
}

TEST(JointView, SaysWhereTheProbeStandsAndWhatIsSeenHowDeep) {
  const auto joint = parse_joint(kViewedArm + kViewSaid + "pose = \"bent\"\ndepth = 40\n" +
                                     kViewStands + kViewSees + "side = \"left\"\n",
                                 "j");
  ASSERT_TRUE(joint) << joint.error().to_string();
  ASSERT_EQ(joint->views.size(), 1U);
  const StandardView& view = joint->views[0];
  EXPECT_EQ(view.name, "front");
  EXPECT_EQ(view.source, "[A2000]");
  EXPECT_EQ(view.pose, "bent");
  EXPECT_DOUBLE_EQ(view.depth, 40e-3);
  EXPECT_LT((view.X_JP.translation() - Vec3(1e-3, 2e-3, 3e-3)).norm(), 1e-12);
  ASSERT_EQ(view.sights.size(), 1U);
  EXPECT_EQ(view.sights[0].structure, "ulna");
  EXPECT_DOUBLE_EQ(view.sights[0].least, 3e-3);
  EXPECT_DOUBLE_EQ(view.sights[0].most, 9e-3);
  EXPECT_EQ(view.sights[0].side, ViewSide::left);
}

TEST(JointView, DoesNotShapeTheBody) {
  const auto with = parse_joint(kViewedArm + kViewSaid + kViewStands + kViewSees, "j");
  const auto without = parse_joint(kViewedArm, "j");
  ASSERT_TRUE(with && without);
  EXPECT_EQ(with->shape, without->shape);
}

TEST(JointView, TellsWhatIsWrongWithIt) {
  EXPECT_EQ(refused_view(kViewSaid + kViewStands + kViewSees), "");
  EXPECT_THAT(refused_view(kViewSaid), HasSubstr("needs its [view.front.probe]"));
  EXPECT_THAT(refused_view("[view.front]\n" + kViewStands), HasSubstr("source"));
  EXPECT_THAT(refused_view(kViewSaid + "pose = \"bend\"\n" + kViewStands),
              HasSubstr("no [pose.bend]"));
  EXPECT_THAT(refused_view(kViewSaid + kViewStands +
                           "[[view.front.see]]\nstructure = \"ulan\"\ndepth = [3, 9]\n"),
              HasSubstr("(did you mean 'ulna'?)"));
  EXPECT_THAT(refused_view(kViewSaid + kViewStands +
                           "[[view.front.see]]\nstructure = \"ulna\"\ndepth = [9, 3]\n"),
              HasSubstr("the greater one second"));
  EXPECT_THAT(refused_view(kViewSaid + kViewStands + kViewSees + "side = \"up\"\n"),
              HasSubstr("side"));
}

}  // namespace
}  // namespace artus
