// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/dataset/pose_list.h"

#include <gtest/gtest.h>

#include "artus/detail/core/units.h"

namespace artus {
namespace {

constexpr const char* kTwo =
    R"({"name": "a", "time_s": 0, "probe": {"position_mm": [1, 2, 3], "direction": [0, 0, 2], "lateral": [1, 0, 0]}, "needle": {"entry_mm": [0, 0, 0], "tip_mm": [0, 0, 20]}}

{"time_s": 2, "probe": {"position_mm": [5, 2, 3], "direction": [0, 0, 1], "lateral": [0, 1, 0]}, "needle": {"entry_mm": [0, 0, 0], "tip_mm": [10, 0, 20]}}
)";

TEST(PoseList, ReadsJsonLinesInMillimetres) {
  const auto poses = parse_poses_jsonl(kTwo, "two.jsonl");
  ASSERT_TRUE(poses.has_value()) << poses.error().to_string();
  ASSERT_EQ(poses->size(), 2U);
  EXPECT_EQ((*poses)[0].name, "a");
  EXPECT_LT(((*poses)[0].X_JP.translation() - Vec3(1e-3, 2e-3, 3e-3)).norm(), 1e-15);
  EXPECT_LT(((*poses)[0].X_JP.linear().col(2) - Vec3::UnitZ()).norm(), 1e-15);
  EXPECT_LT(((*poses)[1].X_JP.linear().col(0) - Vec3::UnitY()).norm(), 1e-15);
  ASSERT_TRUE((*poses)[0].X_JN.has_value());
  EXPECT_LT(((*poses)[0].X_JN->translation() - Vec3(0, 0, 20e-3)).norm(), 1e-15);
}

TEST(PoseList, ReadsTheSameFromCsv) {
  const auto poses = parse_poses_csv(
      "name,probe_x_mm,probe_y_mm,probe_z_mm,direction_x,direction_y,direction_z,lateral_x,"
      "lateral_y,lateral_z,entry_x_mm,entry_y_mm,entry_z_mm,tip_x_mm,tip_y_mm,tip_z_mm\r\n"
      "a,1,2,3,0,0,2,1,0,0,0,0,0,0,0,20\r\n"
      "b,1,2,3,0,0,1,,,,,,,,,\n",
      "two.csv");
  ASSERT_TRUE(poses.has_value()) << poses.error().to_string();
  const auto same = parse_poses_jsonl(kTwo, "two.jsonl");
  EXPECT_TRUE((*poses)[0].X_JP.isApprox((*same)[0].X_JP));
  EXPECT_TRUE((*poses)[0].X_JN->isApprox(*(*same)[0].X_JN));
  EXPECT_FALSE((*poses)[1].X_JN.has_value());
}

TEST(PoseList, ReadsWhatItWrites) {
  const auto poses = parse_poses_jsonl(kTwo, "two.jsonl");
  ASSERT_TRUE(poses);
  std::vector<ListedPose> written = *poses;
  written.push_back(
      {"alone", 2.1, make_pose(Vec3(1e-2, 0, 3e-3), Vec3(1, 2, 3), Vec3(0, 3, -2)), {}});
  const auto read = parse_poses_csv(poses_csv(written), "written.csv");
  ASSERT_TRUE(read) << read.error().to_string();
  ASSERT_EQ(read->size(), 3U);
  for (std::size_t i = 0; i < read->size(); ++i) {
    const ListedPose& a = (*read)[i];
    const ListedPose& b = written[i];
    EXPECT_EQ(a.name, b.name);
    EXPECT_EQ(a.time, b.time);
    EXPECT_TRUE(a.X_JP.isApprox(b.X_JP, 1e-14));
    ASSERT_EQ(a.X_JN.has_value(), b.X_JN.has_value());
    EXPECT_TRUE(!a.X_JN || a.X_JN->isApprox(*b.X_JN, 1e-14));
  }
}

TEST(PoseList, RefusesWhatIsNoPoseWithFileAndLine) {
  const std::string good = R"({"probe": {"position_mm": [1, 2, 3], "direction": [0, 0, 1]}})"
                           "\n";
  for (
      const char* bad :
      {"[1, 2]", "{", R"({"prob": {}})", R"({"probe": {"position_mm": [1, 2, 3]}})",
       R"({"probe": {"position_mm": [1, 2], "direction": [0, 0, 1]}})",
       R"({"probe": {"position_mm": [1, 2, 1e999], "direction": [0, 0, 1]}})",
       R"({"probe": {"position_mm": [1, 2, 3], "direction": [0, 0, 0]}})",
       R"({"probe": {"position_mm": [1, 2, 3], "direction": [0, 0, 1], "lateral": [0, 0, 3]}})",
       R"({"probe": {"position_mm": [1, 2, 3], "direction": [0, 0, 1]}, "needle": {"tip_mm": [0, 0, 1]}})",
       R"({"probe": 3})", R"({"time_s": "now"})"}) {
    const auto poses = parse_poses_jsonl(good + bad + "\n", "bad.jsonl");
    ASSERT_FALSE(poses.has_value()) << bad;
    EXPECT_EQ(poses.error().where, "bad.jsonl:2") << bad;
  }
  EXPECT_FALSE(parse_poses_jsonl("\n\n", "empty.jsonl").has_value());
  const std::string header = "probe_x_mm,probe_y_mm,probe_z_mm,direction_x,direction_y,direction_z";
  for (const std::string& bad :
       {header + ",colour\n1,2,3,0,0,1,7\n", header + "\n1,2,3,0,0\n", header + "\n1,2,x,0,0,1\n",
        header + "\n1,2,,0,0,1\n", header + "\n1,2,nan,0,0,1\n", header + "," + header + "\n",
        header + "\n"}) {
    EXPECT_FALSE(parse_poses_csv(bad, "bad.csv").has_value()) << bad;
  }
  EXPECT_EQ(read_poses("absent.jsonl").error().code, ErrorCode::not_found);
  EXPECT_EQ(read_poses("poses.txt").error().code, ErrorCode::unsupported);
}

TEST(PoseList, TimesMustRise) {
  std::string text = kTwo;
  text.replace(text.find("\"time_s\": 2"), 11, "\"time_s\": 0");
  EXPECT_FALSE(parse_poses_jsonl(text, "two.jsonl").has_value());
}

TEST(PoseList, APathMovesStraightAndTurnsEvenly) {
  const auto poses = parse_poses_jsonl(kTwo, "two.jsonl");
  const auto path = sample_path(*poses, 10);
  ASSERT_TRUE(path.has_value());
  ASSERT_EQ(path->size(), 21U);
  const ListedPose& middle = (*path)[10];
  EXPECT_LT((middle.X_JP.translation() - Vec3(3e-3, 2e-3, 3e-3)).norm(), 1e-12);
  EXPECT_LT((middle.X_JP.linear().col(0) - Vec3(1, 1, 0).normalized()).norm(), 1e-12);
  EXPECT_LT((middle.X_JN->translation() - Vec3(5e-3, 0, 20e-3)).norm(), 1e-12);
  EXPECT_TRUE(path->back().X_JP.isApprox(poses->back().X_JP));
  auto untimed = *poses;
  for (auto& pose : untimed) pose.time.reset();
  EXPECT_EQ(sample_path(untimed, 10)->size(), 2U);
  untimed[0].time = 0;
  EXPECT_FALSE(sample_path(untimed, 10).has_value());
}

TEST(PoseList, APathOfMorePosesThanMemoryHoldsIsRefusedBeforeAnyIsMade) {
  auto poses = parse_poses_jsonl(kTwo, "two.jsonl").value();
  for (const double end : {1e6, 1e9, 1e300}) {
    poses.back().time = end;
    const auto path = sample_path(poses, 1000);
    ASSERT_FALSE(path.has_value()) << end;
    EXPECT_NE(path.error().message.find("at 1000 a second"), std::string::npos);
  }
  poses.back().time = 2;
  EXPECT_FALSE(sample_path(poses, 10, 20).has_value());
  EXPECT_TRUE(sample_path(poses, 10, 21).has_value());
}

TEST(PoseList, ANeedleAloneIsAPoseWhereTheNeedleIsWhatCounts) {
  const std::string text =
      "entry_x_mm,entry_y_mm,entry_z_mm,tip_x_mm,tip_y_mm,tip_z_mm\n0,0,0,0,0,9\n";
  EXPECT_FALSE(parse_poses_csv(text, "needle.csv").has_value());
  const auto poses = parse_poses_csv(text, "needle.csv", PoseHand::needle);
  ASSERT_TRUE(poses.has_value()) << poses.error().to_string();
  EXPECT_FALSE(poses->front().has_probe);
  EXPECT_TRUE(parse_poses_jsonl(kTwo, "two.jsonl", PoseHand::needle)->front().has_probe);
}

TEST(PoseList, APlaceThatNoJointHasIsRefusedWithItsDistance) {
  const auto far = parse_poses_jsonl(
      R"({"probe": {"position_mm": [766000, 0, 0], "direction": [0, 0, 1]}})", "far.jsonl");
  ASSERT_FALSE(far.has_value());
  EXPECT_NE(far.error().message.find("766 m from the joint's origin"), std::string::npos);
}

}  // namespace
}  // namespace artus
