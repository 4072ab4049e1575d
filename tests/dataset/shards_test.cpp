// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/dataset/shards.h"

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

#include "artus/detail/core/text_file.h"
#include "artus/detail/dataset/secure_hash.h"
#include "artus/detail/dataset/shard_merge.h"
#include "artus/detail/dataset/shard_stats.h"
#include "artus/detail/dataset/stored_sweep.h"
#include "artus/detail/dataset/sweep_frame.h"
#include "artus/detail/dataset/tar_file.h"
#include "tests/dataset/shards_fixture.h"
#include "tests/support/process.h"

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

using test::Shards;

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
  const SweepFrame frame = drawer.draw(3, source_.frame(3));
  for (const TarMember& member : *members) {
    const std::vector<std::uint8_t> bytes(member.bytes.begin(), member.bytes.end());
    if (member.name == "000000003.png") {
      EXPECT_EQ(cv::norm(cv::imdecode(bytes, cv::IMREAD_UNCHANGED), frame.pictures[0].second), 0);
    }
    if (member.name == "000000003.labels_shown.png") {
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
  EXPECT_EQ(summed.out.substr(0, 64), sidecar["sha256"].get<std::string>());
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
  EXPECT_THAT(merge({"a"}).problems, Contains(HasSubstr("its sha256 differs")));
  EXPECT_FALSE(merge_shards({folder_ / "nowhere"}, folder_ / "set.json"));
}

TEST_F(Shards, StatisticsCountWhatIsInTheSet) {
  ASSERT_TRUE(write("set"));
  const auto statistics = read_statistics({folder_ / "set"});
  ASSERT_TRUE(statistics) << statistics.error().to_string();
  EXPECT_EQ(statistics->frames, 10U);
  std::size_t needles = 0;
  for (std::size_t i = 0; i < 10; ++i) needles += source_.frame(i).X_JN ? 1 : 0;
  EXPECT_EQ(statistics->with_needle, needles);
  EXPECT_EQ(statistics->regions.at("fat"), 10U);
  const auto& x = statistics->values.at("probe x, mm");
  ASSERT_EQ(x.size(), 10U);
  EXPECT_NEAR(x[4], 1e3 * source_.frame(4).X_JP.translation().x(), 1e-9);
  const auto summary = to_json(*statistics)["min_quartiles_max"]["probe x, mm"];
  EXPECT_EQ(summary[0], *std::min_element(x.begin(), x.end()));
  EXPECT_EQ(summary[4], *std::max_element(x.begin(), x.end()));
  const cv::Mat page = histogram_page(*statistics);
  EXPECT_GT(cv::countNonZero(page.reshape(1) < 200), 5000);  // something is drawn
  EXPECT_FALSE(read_statistics({folder_ / "nowhere"}));
}

TEST_F(Shards, AreReadBackWithTheirPosesAndPictures) {
  ASSERT_TRUE(write("set"));
  SweepDrawer drawer(scene_, options_.sweep);
  std::size_t i = 0;
  const auto read = read_sweep(folder_ / "set", [&](const StoredFrame& stored) -> Result<void> {
    const FrameOrder order = source_.frame(i);
    EXPECT_TRUE(stored.pose.X_JP.isApprox(order.X_JP, 1e-9)) << i;
    EXPECT_EQ(stored.pose.X_JN.has_value(), order.X_JN.has_value());
    if (order.X_JN) {
      EXPECT_TRUE(stored.pose.X_JN->translation().isApprox(order.X_JN->translation(), 1e-9));
      EXPECT_GT(stored.pose.X_JN->linear().col(2).dot(order.X_JN->linear().col(2)), 1 - 1e-9);
    }
    EXPECT_NEAR(stored.transducer.width, options_.sweep.transducer.width, 1e-12);
    const SweepFrame frame = drawer.draw(i, order);
    const cv::Mat& image = frame.pictures[0].second;
    EXPECT_EQ(stored.grey, std::vector<std::uint8_t>(image.datastart, image.dataend));
    ++i;
    return {};
  });
  ASSERT_TRUE(read) << read.error().to_string();
  EXPECT_EQ(i, 10U);
}

TEST_F(Shards, ThatAreDamagedAreNotReadBack) {
  const auto ignore = [](const StoredFrame&) -> Result<void> {
    return {};
  };
  const auto nowhere = read_sweep(folder_ / "nowhere", ignore);
  ASSERT_FALSE(nowhere);
  EXPECT_EQ(nowhere.error().code, ErrorCode::not_found);
  ASSERT_TRUE(write("set"));
  std::string bytes = *read_bytes(folder_ / "set/shard-000000.tar");
  const std::size_t picture = bytes.find("\x89PNG");
  bytes[picture + 60] = static_cast<char>(bytes[picture + 60] ^ 0x55);
  ASSERT_TRUE(write_text(folder_ / "set/shard-000000.tar", bytes.substr(0, 2000)));
  EXPECT_FALSE(read_sweep(folder_ / "set", ignore));
  const auto stopped = read_sweep(folder_ / "set", [](const StoredFrame&) -> Result<void> {
    return fail(ErrorCode::failed, "enough");
  });
  EXPECT_FALSE(stopped);
}

}  // namespace
}  // namespace artus
