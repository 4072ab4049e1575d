// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/dataset/shards.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <string>

#include <gmock/gmock.h>
#include <opencv2/imgcodecs.hpp>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "artus/core/rigid.h"
#include "artus/core/text_file.h"
#include "artus/core/units.h"
#include "artus/dataset/pose_draw.h"
#include "artus/dataset/secure_hash.h"
#include "artus/dataset/shard_merge.h"
#include "artus/dataset/shard_stats.h"
#include "artus/dataset/sweep_frame.h"
#include "artus/dataset/tar_file.h"
#include "artus/evidence/echo/echo_phantom.h"
#include "tests/support/process.h"
#include "tests/support/temporary_folder.h"

namespace artus {
namespace {

namespace fs = std::filesystem;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;

TEST(Sha256, HasThePublishedValues) {
  EXPECT_EQ(sha256_hex(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256_hex("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256_hex("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(sha256_hex(std::string(1'000'000, 'a')),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

class Shards : public test::TemporaryFolder {
 protected:
  void SetUp() override {
    TemporaryFolder::SetUp();
    const std::array<FlatLayer, 3> layers{{{"fat", 5e-3}, {"muscle", 12e-3}, {"bone", 20e-3}}};
    scene_ = make_block_scene(layers);
    options_.sweep.transducer.n_lines = 32;
    options_.sweep.settings.n_samples = 256;
    options_.sweep.settings.n_planes = 1;
    options_.sweep.settings.pixel = 0.5e-3;
    options_.frames = 3;
    options_.engine = "1.0";
    DrawRanges ranges;
    ranges.lateral = {-5e-3, 5e-3};
    source_ = drawn_poses(scene_, ranges, 7, 10);  // four shards, the last of one frame
  }
  [[nodiscard]] Result<ShardResult> write(const std::string& name, const ShardJob& job = {}) const {
    return write_shards(scene_, source_, job, folder_ / name, options_);
  }
  [[nodiscard]] std::map<std::string, std::string> content(const std::string& name) const {
    std::map<std::string, std::string> files;
    for (const auto& entry : fs::directory_iterator(folder_ / name))
      files[entry.path().filename().string()] = *read_bytes(entry.path());
    return files;
  }
  [[nodiscard]] MergedSet merge(const std::vector<std::string>& names) const {
    std::vector<fs::path> folders;
    for (const std::string& name : names) folders.push_back(folder_ / name);
    const auto set = merge_shards(folders, folder_ / "set.json");
    EXPECT_TRUE(set) << set.error().to_string();
    return set.value_or(MergedSet{});
  }

  std::shared_ptr<const Scene> scene_;
  PoseSource source_;
  ShardOptions options_;
};

TEST_F(Shards, AreTheSameBytesWhoeverDrawsThem) {
  ASSERT_TRUE(write("whole"));
  for (std::size_t turn = 0; turn < 3; ++turn) {
    ShardJob job;
    job.turn = turn;
    job.of = 3;
    ASSERT_TRUE(write("jobs", job));
  }
  options_.sweep.settings.n_threads = 1;
  ASSERT_TRUE(write("ranges", *parse_frames("6:10", "")));
  ASSERT_TRUE(write("ranges", *parse_frames("0:6", "")));
  const auto whole = content("whole");
  EXPECT_EQ(whole.size(), 8U);
  EXPECT_EQ(content("jobs"), whole);
  EXPECT_EQ(content("ranges"), whole);
}

TEST_F(Shards, HoldASampleForEachFrameAsWebDatasetGroupsThem) {
  ASSERT_TRUE(write("set"));
  const std::string archive = *read_bytes(folder_ / "set/shard-000001.tar");
  const auto members = list_members(archive);
  ASSERT_TRUE(members) << members.error().to_string();
  std::map<std::string, std::set<std::string>> samples;  // a key ends at the name's first dot
  for (const TarMember& member : *members) {
    const std::size_t dot = member.name.find('.');
    samples[std::string(member.name.substr(0, dot))].emplace(member.name.substr(dot + 1));
  }
  ASSERT_EQ(samples.size(), 3U);
  EXPECT_EQ(samples.begin()->first, "000000003");
  SweepDrawer drawer(scene_, options_.sweep);
  const SweepFrame frame = drawer.draw(3, source_.pose(3));
  for (const TarMember& member : *members) {
    const std::vector<std::uint8_t> bytes(member.bytes.begin(), member.bytes.end());
    if (member.name == "000000003.png") {
      EXPECT_EQ(cv::norm(cv::imdecode(bytes, cv::IMREAD_UNCHANGED), frame.pictures[0].second), 0);
    }
    if (member.name == "000000003.labels.png") {
      const cv::Mat labels = cv::imdecode(bytes, cv::IMREAD_UNCHANGED);
      EXPECT_EQ(labels.type(), CV_8UC1);
      cv::Mat wide;
      labels.convertTo(wide, CV_16U);
      EXPECT_EQ(cv::norm(wide, frame.pictures[1].second, cv::NORM_INF), 0);
    }
    if (member.name == "000000003.json") {
      EXPECT_EQ(nlohmann::json::parse(member.bytes), frame.truth);
    }
  }
}

TEST_F(Shards, AreReadByTheSystemsTar) {
  ASSERT_TRUE(write("set"));
  const auto listed =
      test::run_process({"tar", "-tvf", (folder_ / "set/shard-000000.tar").string()});
  EXPECT_EQ(listed.exit_code, 0) << listed.err;
  EXPECT_THAT(listed.out, HasSubstr("000000002.json"));
  const auto summed = test::run_process({"sha256sum", (folder_ / "set/shard-000000.tar").string()});
  const auto sidecar = nlohmann::json::parse(*read_bytes(folder_ / "set/shard-000000.json"));
  EXPECT_EQ(summed.out.substr(0, 64), sidecar["sha256"]);
  EXPECT_EQ(sidecar["sweep"]["engine"], "1.0");
}

TEST_F(Shards, AStoppedJobLosesItsOpenShardAloneAndGoesOn) {
  ASSERT_TRUE(write("whole"));
  int asked = 0;
  options_.sweep.stop = [&asked] {
    return ++asked > 4;
  };
  const auto first = write("stopped");
  ASSERT_TRUE(first);
  EXPECT_EQ(first->drawn, 1U);  // the second was open
  options_.sweep.stop = {};
  const auto second = write("stopped");
  ASSERT_TRUE(second);
  EXPECT_EQ(second->found, 1U);
  EXPECT_EQ(second->drawn, 3U);
  EXPECT_EQ(content("stopped"), content("whole"));
}

TEST_F(Shards, AHalfWrittenShardIsDrawnAgain) {
  ASSERT_TRUE(write("whole"));
  ASSERT_TRUE(write("torn"));
  fs::resize_file(folder_ / "torn/shard-000001.tar", 1000);
  fs::remove(folder_ / "torn/shard-000002.json");
  const auto again = write("torn");
  ASSERT_TRUE(again);
  EXPECT_EQ(again->drawn, 2U);
  EXPECT_EQ(content("torn"), content("whole"));
}

TEST_F(Shards, RefuseAnotherSweepsFolderAndFramesThatCutAShard) {
  ASSERT_TRUE(write("set"));
  options_.sweep.settings.gain_db += 1;
  const auto other = write("set");
  ASSERT_FALSE(other);
  EXPECT_THAT(other.error().message, HasSubstr("another sweep"));
  const auto cut = write("new", *parse_frames("1:6", ""));
  ASSERT_FALSE(cut);
  EXPECT_THAT(cut.error().message, HasSubstr("multiples of 3"));
  EXPECT_FALSE(write("new", *parse_frames("0:12", "")));
  for (const char* bad : {"", "3", "3/3", "-1/3", "a/b", "1/2/3"})
    EXPECT_FALSE(parse_turn(bad, "--shard")) << bad;
}

TEST_F(Shards, MergeListsASetThatIsWhole) {
  ASSERT_TRUE(write("a", *parse_frames("0:6", "")));
  ASSERT_TRUE(write("b", *parse_frames("6:10", "")));
  const MergedSet set = merge({"a", "b"});
  EXPECT_THAT(set.problems, ElementsAre());
  EXPECT_EQ(set.frames, 10U);
  const auto list = nlohmann::json::parse(*read_bytes(folder_ / "set.json"));
  EXPECT_EQ(list["shards"].size(), 4U);
  EXPECT_EQ(list["shards"][3]["first"], 9);
}

TEST_F(Shards, MergeFindsMissingDoubledForeignAndDamagedShards) {
  ASSERT_TRUE(write("a", *parse_frames("0:6", "")));
  ASSERT_TRUE(write("b", *parse_frames("3:6", "")));
  EXPECT_THAT(merge({"a", "b"}).problems, Contains(HasSubstr("doubled, frames 3:6")));
  EXPECT_THAT(merge({"a"}).problems, ElementsAre("missing: frames 6:10"));
  EXPECT_FALSE(fs::exists(folder_ / "set.json"));
  options_.engine = "2.0";
  ASSERT_TRUE(write("c", *parse_frames("6:10", "")));
  EXPECT_THAT(merge({"a", "c"}).problems, Contains(HasSubstr("foreign")));
  std::string bytes = *read_bytes(folder_ / "a/shard-000000.tar");
  bytes[700] = static_cast<char>(bytes[700] ^ 1);
  ASSERT_TRUE(write_text(folder_ / "a/shard-000000.tar", bytes));
  EXPECT_THAT(merge({"a"}).problems, Contains(HasSubstr("another sha256")));
  EXPECT_FALSE(merge_shards({folder_ / "nowhere"}, folder_ / "set.json"));
}

TEST_F(Shards, StatisticsCountWhatIsInTheSet) {
  ASSERT_TRUE(write("set"));
  const auto statistics = read_statistics({folder_ / "set"});
  ASSERT_TRUE(statistics) << statistics.error().to_string();
  EXPECT_EQ(statistics->frames, 10U);
  std::size_t needles = 0;
  for (std::size_t i = 0; i < 10; ++i) needles += source_.pose(i).X_JN ? 1 : 0;
  EXPECT_EQ(statistics->with_needle, needles);
  EXPECT_EQ(statistics->regions.at("fat"), 10U);
  const auto& x = statistics->values.at("probe x, mm");
  ASSERT_EQ(x.size(), 10U);
  EXPECT_NEAR(x[4], 1e3 * source_.pose(4).X_JP.translation().x(), 1e-9);
  const auto summary = to_json(*statistics)["least_quartiles_most"]["probe x, mm"];
  EXPECT_EQ(summary[0], *std::min_element(x.begin(), x.end()));
  EXPECT_EQ(summary[4], *std::max_element(x.begin(), x.end()));
  const cv::Mat page = histogram_page(*statistics);
  EXPECT_GT(cv::countNonZero(page.reshape(1) < 200), 5000);  // something is drawn
  EXPECT_FALSE(read_statistics({folder_ / "nowhere"}));
}

TEST_F(Shards, ADrawnPoseDependsOnItsNumberAndTheSeedAlone) {
  const DrawRanges ranges;
  const PoseSource few = drawn_poses(scene_, ranges, 7, 5);
  const PoseSource many = drawn_poses(scene_, ranges, 7, 1'000'000'000);
  const PoseSource other = drawn_poses(scene_, ranges, 8, 5);
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_EQ(few.pose(i).X_JP.matrix(), many.pose(i).X_JP.matrix());
    EXPECT_NE(few.pose(i).X_JP.matrix(), other.pose(i).X_JP.matrix());
    EXPECT_EQ(few.pose(i).X_JN.has_value(), many.pose(i).X_JN.has_value());
  }
  EXPECT_NE(few.digest, other.digest);
}

TEST_F(Shards, DrawnPosesFillTheirRangesAndStandOnTheSkin) {
  DrawRanges ranges;
  ranges.tilt = ranges.rock = {0, 0};
  const PoseSource source = drawn_poses(scene_, ranges, 3, 2000);
  const Pose& middle = scene_->joint().X_JP_default;
  std::size_t needles = 0;
  std::size_t flat = 0;  // in the probe's plane
  double least = 1;
  double most = -1;
  for (std::size_t i = 0; i < source.count; ++i) {
    const ListedPose pose = source.pose(i);
    ASSERT_TRUE(is_rigid(pose.X_JP));
    const Vec3 moved = middle.inverse() * pose.X_JP.translation();
    least = std::min(least, moved.x());
    most = std::max(most, moved.x());
    EXPECT_NEAR(scene_->signed_distance_to_skin(pose.X_JP.translation(), 0.1), 0, 1e-9);
    if (!pose.X_JN) continue;
    ++needles;
    const Pose X_PN = pose.X_JP.inverse() * *pose.X_JN;
    flat += std::abs(X_PN.translation().y()) < 1e-9 && std::abs(X_PN(1, 2)) < 1e-9 ? 1 : 0;
  }
  EXPECT_NEAR(least, -10e-3, 0.1e-3);
  EXPECT_NEAR(most, 10e-3, 0.1e-3);
  EXPECT_NEAR(static_cast<double>(needles) / 2000, 0.7, 0.035);  // three standard deviations
  EXPECT_NEAR(static_cast<double>(flat) / static_cast<double>(needles), 0.5, 0.041);
}

TEST(DrawRanges, AreReadWithEverythingThatIsWrong) {
  const auto ranges = parse_draw_ranges(
      "[probe]\nlateral_mm = [-3, 4]\ntilt_deg = [0, 0]\n[needle]\nshare = 0.25\n", "ranges.toml");
  ASSERT_TRUE(ranges) << ranges.error().to_string();
  EXPECT_DOUBLE_EQ(ranges->lateral.low, -3e-3);
  EXPECT_DOUBLE_EQ(ranges->tilt.high, 0);
  EXPECT_DOUBLE_EQ(ranges->needle_share, 0.25);
  EXPECT_DOUBLE_EQ(ranges->turn.high, DrawRanges{}.turn.high);
  const auto bad = parse_draw_ranges(
      "[probe]\nlateral_mm = [4, -3]\nlaterl_mm = [0, 1]\n[patient]\n[needle]\nshare = 2\n",
      "ranges.toml");
  ASSERT_FALSE(bad);
  for (const char* says : {"[low, high]", "laterl_mm", "patient", "share"})
    EXPECT_THAT(bad.error().message, HasSubstr(says));
}

}  // namespace
}  // namespace artus
