// SPDX-License-Identifier: AGPL-3.0-or-later
#include <string>

#include <gmock/gmock.h>

#include "artus/anatomy/joint_file.h"
#include "artus/detail/anatomy/source/joint_pose_toml.h"

namespace artus {
namespace {

using testing::HasSubstr;

const std::string kArm =
    "format = 1\nname = \"elbow\"\nunits = \"mm\"\naxes = \"LPS\"\n"
    "[body]\nfile = \"body.stl\"\ntissue = \"fat\"\n"
    "[[structure]]\nname = \"ulna\"\ntissue = \"bone\"\nfile = \"ulna.stl\"\n"
    "[[structure]]\nname = \"biceps\"\ntissue = \"muscle\"\nfile = \"b.stl\"\n"
    "[[landmark]]\nname = \"trochlea\"\nposition = [10, 0, 0]\n";

std::string refused(const std::string& pose) {
  const auto joint = parse_joint(kArm + pose, "j");
  return joint ? "" : joint.error().to_string();
}

TEST(JointPose, TurnsAboutAnAxisThroughALandmarkAndThenShifts) {
  const auto joint = parse_joint(kArm +
                                     "[pose.bent]\ntitle = \"bent\"\n[[pose.bent.move]]\n"
                                     "structures = [\"ulna\"]\naxis = [0, 0, 2]\n"
                                     "through = \"trochlea\"\ndegrees = 90\nshift = [0, 0, 3]\n"
                                     "[pose.bent.probe]\nposition = [1, 2, 3]\n"
                                     "direction = [0, 0, 1]\n[pose.straight]\n",
                                 "j");
  ASSERT_TRUE(joint) << joint.error().to_string();
  ASSERT_EQ(joint->poses.size(), 2U);
  const JointPose& bent = joint->poses[0];
  EXPECT_EQ(bent.title, "bent");
  ASSERT_EQ(bent.motions.size(), 1U);
  EXPECT_EQ(bent.motions[0].structure, "ulna");
  const Vec3 p = bent.motions[0].X_J * Vec3(11e-3, 0, 0);
  EXPECT_LT((p - Vec3(10e-3, 1e-3, 3e-3)).norm(), 1e-12);
  EXPECT_LT((bent.X_JP->translation() - Vec3(1e-3, 2e-3, 3e-3)).norm(), 1e-12);
  EXPECT_EQ(joint->poses[1].name, "straight");
  EXPECT_TRUE(joint->poses[1].motions.empty());
}

TEST(JointPose, TellsWhatIsWrongWithIt) {
  const auto move = [](const std::string& keys) {
    return refused("[pose.a]\n[[pose.a.move]]\n" + keys);
  };
  const std::string turn = "axis = [0, 0, 1]\nthrough = [0, 0, 0]\ndegrees = 10\n";
  EXPECT_EQ(move("structures = [\"ulna\"]\n" + turn), "");
  EXPECT_THAT(move("structures = [\"ulan\"]\n" + turn),
              HasSubstr("'ulan' is no structure (did you mean 'ulna'?)"));
  EXPECT_THAT(move("structures = [\"biceps\"]\n" + turn), HasSubstr("'biceps' is no bone"));
  EXPECT_THAT(move("structures = [\"ulna\", \"ulna\"]\n" + turn), HasSubstr("moves twice"));
  EXPECT_THAT(move(turn), HasSubstr("structures"));
  EXPECT_THAT(move("structures = [\"ulna\"]\n"), HasSubstr("degrees"));
  EXPECT_THAT(move("structures = [\"ulna\"]\naxis = [0, 0, 0]\nthrough = [0, 0, 0]\ndegrees = 1\n"),
              HasSubstr("must not be zero"));
  EXPECT_THAT(
      move("structures = [\"ulna\"]\naxis = [0, 0, nan]\nthrough = [0, 0, 0]\ndegrees = 1\n"),
      HasSubstr("axis"));
  EXPECT_THAT(
      move("structures = [\"ulna\"]\naxis = [0, 0, 1]\nthrough = [0, 0, 0]\ndegrees = nan\n"),
      HasSubstr("degrees"));
  EXPECT_THAT(
      move("structures = [\"ulna\"]\naxis = [0, 0, 1]\nthrough = [0, 0, 0]\ndegrees = 121\n"),
      HasSubstr("degrees"));
  EXPECT_THAT(
      move("structures = [\"ulna\"]\naxis = [0, 0, 1]\nthrough = \"trochle\"\ndegrees = 1\n"),
      HasSubstr("did you mean 'trochlea'?"));
  EXPECT_THAT(move("structures = [\"ulna\"]\nshift = [300, 0, 0]\n"), HasSubstr("20 cm"));
  EXPECT_THAT(move("structures = [\"ulna\"]\n" + turn + "angle = 3\n"), HasSubstr("angle"));
  EXPECT_THAT(refused("[pose.Up]\n"), HasSubstr("a-z"));
  EXPECT_THAT(refused("[pose.a]\nmoves = 1\n"), HasSubstr("moves"));
}

TEST(JointPose, ProbeWithoutADirectionIsNoPose) {
  const auto table = parse_toml("position = [1, 2, 3]\ndirection = [0, 0, 0]", "t").value();
  Problems problems;
  TomlTable toml(table, "probe", problems);
  EXPECT_FALSE(read_probe_pose(toml, 1e-3));
  EXPECT_FALSE(problems.empty());
}

}  // namespace
}  // namespace artus
