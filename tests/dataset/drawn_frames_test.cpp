// SPDX-License-Identifier: AGPL-3.0-or-later
// Frames drawn at random: what they depend on, what they fill, what they say of themselves.
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <string>

#include <gmock/gmock.h>
#include <opencv2/core.hpp>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "artus/detail/core/rigid.h"
#include "artus/detail/dataset/draw_ranges.h"
#include "artus/detail/dataset/frame_order.h"
#include "artus/detail/dataset/sweep_frame.h"
#include "artus/echo/labels.h"
#include "tests/dataset/shards_fixture.h"

namespace artus {
namespace {

namespace fs = std::filesystem;
using test::Shards;
using testing::ElementsAre;
using testing::HasSubstr;

TEST_F(Shards, ADrawnPoseDependsOnItsNumberAndTheSeedAlone) {
  const DrawRanges ranges;
  const DrawBase base{{scene_}, {}};
  const FrameSource few = drawn_frames(base, ranges, 7, 5);
  const FrameSource many = drawn_frames(base, ranges, 7, 1'000'000'000);
  const FrameSource other = drawn_frames(base, ranges, 8, 5);
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_EQ(few.frame(i).X_JP.matrix(), many.frame(i).X_JP.matrix());
    EXPECT_NE(few.frame(i).X_JP.matrix(), other.frame(i).X_JP.matrix());
    EXPECT_EQ(few.frame(i).X_JN.has_value(), many.frame(i).X_JN.has_value());
  }
  EXPECT_NE(few.digest, other.digest);
}

TEST_F(Shards, DrawnPosesFillTheirRangesAndStandOnTheSkin) {
  DrawRanges ranges;
  ranges.tilt = ranges.rock = {0, 0};
  ranges.tip = TipPlace::anywhere;
  ranges.not_in.clear();
  ranges.in_plane_share = 0.5;
  const FrameSource source = drawn_frames({{scene_}, {}}, ranges, 3, 2000);
  const Pose& middle = scene_->joint().X_JP_default;
  std::size_t needles = 0;
  std::size_t flat = 0;  // in the probe's plane
  double least = 1;
  double most = -1;
  for (std::size_t i = 0; i < source.count; ++i) {
    const FrameOrder pose = source.frame(i);
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

/// Ranges that draw everything but a press.
DrawRanges every_range() {
  DrawRanges ranges;
  ranges.gauges = {18, 25};
  ranges.length = DrawRange{30e-3, 90e-3};
  ranges.echogenic_share = 0.5;
  ranges.transducers = {"linear-6-18", "hockey-7-15"};
  ranges.tip = TipPlace::anywhere;  // which needles are thrown again depends on the probe
  ranges.not_in.clear();
  return ranges;
}

DrawBase with_two_probes(std::vector<std::shared_ptr<const Scene>> patients) {
  return {std::move(patients), {}, {Transducer{}, find_transducer("hockey-7-15")->transducer}};
}

/// Where a frame's tip is in its probe's picture.
NeedleTruth truth_of(const FrameOrder& frame) {
  return locate_needle({*frame.X_JN, *frame.needle}, frame.X_JP, Transducer{}, ImageSettings{});
}

TEST_F(Shards, ADrawnTipIsInThePictureAndNeitherItNorItsShaftInBone) {
  const FrameSource source = drawn_frames({{scene_}, {}}, DrawRanges(), 5, 120);
  std::size_t needles = 0;
  for (std::size_t i = 0; i < source.count; ++i) {
    const FrameOrder frame = source.frame(i);
    if (!frame.X_JN) continue;
    ++needles;
    EXPECT_TRUE(truth_of(frame).in_picture) << i;
    EXPECT_TRUE(truth_of(frame).in_slice) << i;
    const Vec3 tip = frame.X_JN->translation();
    for (const double back : {0.0, 5e-3, 10e-3, 20e-3}) {
      const RegionId region = scene_->region_at(tip - back * frame.X_JN->linear().col(2));
      EXPECT_NE(scene_->joint().tissue_of(region).name, "bone") << i;
    }
  }
  EXPECT_GT(needles, 70U) << "of the 0.7 that shall have one";
}

TEST_F(Shards, AShareOfTheTipsMayBeAnywhere) {
  DrawRanges ranges;
  ranges.tip_share = 0.5;
  ranges.not_in = {"bone"};
  const FrameSource source = drawn_frames({{scene_}, {}}, ranges, 5, 150);
  std::size_t needles = 0;
  std::size_t shown = 0;
  for (std::size_t i = 0; i < source.count; ++i) {
    const FrameOrder frame = source.frame(i);
    if (!frame.X_JN) continue;
    ++needles;
    const NeedleTruth truth = truth_of(frame);
    shown += truth.in_picture && truth.in_slice ? 1 : 0;
    EXPECT_NE(scene_->joint().tissue_of(scene_->region_at(frame.X_JN->translation())).name, "bone");
  }
  EXPECT_GT(shown, needles / 2);
  EXPECT_LT(shown, needles);
  DrawRanges unknown;
  unknown.not_in = {"muscle", "femur"};
  EXPECT_THAT(unknown_places({{scene_}, {}}, unknown), ElementsAre("femur"));
}

TEST_F(Shards, ATipThatShallBeVisibleIsReachedBySound) {
  DrawRanges ranges;
  ranges.tip = TipPlace::visible;
  const FrameSource source = drawn_frames({{scene_}, {}}, ranges, 5, 60);
  SweepDrawer drawer(scene_, options_.sweep);
  std::size_t needles = 0;
  std::size_t visible = 0;
  for (std::size_t i = 0; i < source.count; ++i) {
    const FrameOrder frame = source.frame(i);
    if (!frame.X_JN) continue;
    ++needles;
    visible += drawer.draw(i, frame).truth["needle"]["tip_visible"].get<bool>() ? 1 : 0;
  }
  EXPECT_GT(needles, 30U);
  EXPECT_GE(20 * visible, 19 * needles);
}

TEST_F(Shards, ANeedleATransducerAndAPatientAreDrawnEachForItself) {
  const FrameSource source =
      drawn_frames(with_two_probes({scene_, scene_}), every_range(), 3, 3000);
  std::map<std::string, std::size_t> counts;
  double shortest = 1;
  double longest = 0;
  std::size_t needles = 0;
  for (std::size_t i = 0; i < source.count; ++i) {
    const FrameOrder frame = source.frame(i);
    ++counts["patient " + std::to_string(frame.patient)];
    ++counts["transducer " + std::to_string(frame.transducer)];
    EXPECT_EQ(frame.press, 0);
    ASSERT_EQ(frame.needle.has_value(), frame.X_JN.has_value());
    if (!frame.needle) continue;
    ++needles;
    shortest = std::min(shortest, frame.needle->length);
    longest = std::max(longest, frame.needle->length);
    counts["thick"] += frame.needle->outer_diameter == needle_of_gauge(18)->outer_diameter ? 1 : 0;
    counts["thin"] += frame.needle->outer_diameter == needle_of_gauge(25)->outer_diameter ? 1 : 0;
    counts["dimpled"] += frame.needle->echogenic ? 1 : 0;
  }
  for (const char* half : {"patient 0", "patient 1", "transducer 1", "transducer 2"})
    EXPECT_NEAR(static_cast<double>(counts[half]), 1500, 83) << half;  // three deviations
  for (const char* half : {"thick", "thin", "dimpled"})
    EXPECT_NEAR(static_cast<double>(counts[half]), 0.5 * static_cast<double>(needles), 69) << half;
  EXPECT_EQ(counts["thick"] + counts["thin"], needles);
  EXPECT_NEAR(shortest, 30e-3, 0.2e-3);
  EXPECT_NEAR(longest, 90e-3, 0.2e-3);
}

TEST_F(Shards, WhatIsDrawnBesidesLeavesThePosesAsTheyWere) {
  DrawRanges anywhere;
  anywhere.tip = TipPlace::anywhere;
  anywhere.not_in.clear();
  const FrameSource plain = drawn_frames({{scene_}, {}}, anywhere, 7, 50);
  const FrameSource rich = drawn_frames(with_two_probes({scene_}), every_range(), 7, 50);
  EXPECT_NE(plain.digest, rich.digest);
  for (std::size_t i = 0; i < 50; ++i) {
    EXPECT_EQ(plain.frame(i).X_JP.matrix(), rich.frame(i).X_JP.matrix());
    ASSERT_EQ(plain.frame(i).X_JN.has_value(), rich.frame(i).X_JN.has_value());
    if (!plain.frame(i).X_JN) continue;
    EXPECT_EQ(plain.frame(i).X_JN->matrix(), rich.frame(i).X_JN->matrix());
  }
}

class DrawnShards : public Shards {
 protected:
  void SetUp() override {
    Shards::SetUp();
    const std::array<FlatLayer, 2> thin{{{"fat", 9e-3}, {"muscle", 30e-3}}};
    options_.sweep.patients = {make_block_scene(thin)};
    for (const char* name : {"linear-6-18", "hockey-7-15"}) {
      options_.sweep.transducers.push_back(*find_transducer(name));
      options_.sweep.transducers.back().transducer.n_lines = 32;
    }
    source_ =
        drawn_frames(with_two_probes({scene_, options_.sweep.patients[0]}), every_range(), 7, 10);
  }
};

TEST_F(DrawnShards, AreTheSameBytesInAnyOrder) {
  ASSERT_TRUE(write("whole"));
  for (const char* range : {"9:10", "3:6", "6:9", "0:3"})
    ASSERT_TRUE(write("parts", *parse_frames(range, "")));
  EXPECT_EQ(content("parts"), content("whole"));
  SweepDrawer forward(scene_, options_.sweep);
  SweepDrawer backward(scene_, options_.sweep);
  std::map<std::size_t, std::string> truths;
  std::map<std::size_t, cv::Mat> images;
  for (std::size_t i = 0; i < 10; ++i) {
    const SweepFrame frame = forward.draw(i, source_.frame(i));
    truths[i] = frame.truth.dump();
    images[i] = frame.pictures[0].second.clone();
  }
  for (std::size_t i = 10; i-- > 0;) {
    const SweepFrame frame = backward.draw(i, source_.frame(i));
    EXPECT_EQ(frame.truth.dump(), truths[i]);
    EXPECT_EQ(cv::norm(frame.pictures[0].second, images[i], cv::NORM_INF), 0);
  }
}

TEST_F(DrawnShards, SayWhatEachFrameWasDrawnWith) {
  ASSERT_TRUE(write("set"));
  const auto sidecar = nlohmann::json::parse(*read_bytes(folder_ / "set/shard-000000.json"));
  EXPECT_EQ(sidecar["sweep"]["patients"].size(), 1U);
  EXPECT_EQ(sidecar["sweep"]["transducers"][1]["name"], "hockey-7-15");
  SweepDrawer drawer(scene_, options_.sweep);
  for (std::size_t i = 0; i < 10; ++i) {
    const FrameOrder order = source_.frame(i);
    const nlohmann::json truth = drawer.draw(i, order).truth;
    EXPECT_EQ(truth["transducer"], order.transducer == 1 ? "linear-6-18" : "hockey-7-15");
    EXPECT_TRUE(truth.contains("joint"));
    if (!order.X_JN) continue;
    EXPECT_NEAR(truth["needle"]["length_mm"].get<double>(), 1e3 * order.needle->length, 1e-9);
    const Vec3 tip(truth["needle"]["tip_mm"][0], truth["needle"]["tip_mm"][1],
                   truth["needle"]["tip_mm"][2]);
    EXPECT_TRUE(tip.isApprox(1e3 * order.X_JN->translation(), 1e-9));
  }
}

TEST_F(DrawnShards, APressWhereNothingCanBePressedIsNoPress) {
  SweepDrawer drawer(scene_, options_.sweep);  // a phantom without tetrahedra
  FrameOrder order = source_.frame(0);
  order.press = 3e-3;
  const nlohmann::json truth = drawer.draw(0, order).truth;
  ASSERT_TRUE(truth.contains("press"));
  EXPECT_TRUE(truth["press"].is_null());
}

TEST(DrawRanges, AreReadWithEverythingThatIsWrong) {
  const auto ranges = parse_draw_ranges(
      "[probe]\nlateral_mm = [-3, 4]\ntilt_deg = [0, 0]\n[needle]\nshare = 0.25\n", "ranges.toml");
  ASSERT_TRUE(ranges) << ranges.error().to_string();
  EXPECT_DOUBLE_EQ(ranges->lateral.low, -3e-3);
  EXPECT_DOUBLE_EQ(ranges->tilt.high, 0);
  EXPECT_DOUBLE_EQ(ranges->needle_share, 0.25);
  EXPECT_DOUBLE_EQ(ranges->turn.high, DrawRanges{}.turn.high);
  const auto rich = parse_draw_ranges(
      "[needle]\ntip = \"visible\"\nnot_in = [\"bone\"]\ngauge = [20]\nlength_mm = [40, "
      "60]\nechogenic = 0.3\n[press]\nshare = 0.2\n"
      "depth_mm = [1, 3]\n[transducer]\nnames = [\"a\", \"b\"]\n[patient]\njoints = [\"c\"]\ndrawn "
      "= 5\n",
      "there/ranges.toml");
  ASSERT_TRUE(rich) << rich.error().to_string();
  EXPECT_EQ(rich->tip, TipPlace::visible);
  EXPECT_THAT(rich->not_in, ElementsAre("bone"));
  EXPECT_THAT(rich->gauges, ElementsAre(20));
  EXPECT_DOUBLE_EQ(rich->length->high, 60e-3);
  EXPECT_DOUBLE_EQ(rich->press_depth.low, 1e-3);
  EXPECT_THAT(rich->transducers, ElementsAre("a", "b"));
  EXPECT_THAT(rich->joints, ElementsAre(fs::path("there/c")));
  EXPECT_EQ(rich->drawn_patients, 5U);
  const auto bad = parse_draw_ranges(
      "[probe]\nlateral_mm = [4, -3]\nlaterl_mm = [0, 1]\n[patients]\n[needle]\nshare = 2\n"
      "tip = \"here\"\ngauge = [22, 24]\nlength_mm = [5, 50]\n[press]\ndepth_mm = [-1, 2]\n",
      "ranges.toml");
  ASSERT_FALSE(bad);
  for (const char* says : {"[low, high]", "laterl_mm", "patients", "share", "gauge", "in_picture",
                           "from 10", "'depth_mm'"})
    EXPECT_THAT(bad.error().message, HasSubstr(says));
}

}  // namespace
}  // namespace artus
