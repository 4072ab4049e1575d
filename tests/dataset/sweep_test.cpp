// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/dataset/sweep.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <string>

#include <opencv2/imgcodecs.hpp>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "artus/detail/core/units.h"
#include "artus/detail/dataset/echo_truth.h"
#include "artus/detail/dataset/sweep_video.h"
#include "artus/detail/evidence/runs/echo_phantom.h"
#include "tests/support/temporary_folder.h"

namespace artus {
namespace {

namespace fs = std::filesystem;

class Sweep : public test::TemporaryFolder {
 protected:
  void SetUp() override {
    TemporaryFolder::SetUp();
    const std::array<FlatLayer, 3> layers{{{"fat", 5e-3}, {"muscle", 12e-3}, {"bone", 20e-3}}};
    scene_ = make_block_scene(layers);
    options_.transducer.n_lines = 32;
    options_.settings.n_samples = 256;
    options_.settings.n_planes = 1;
    options_.settings.pixel = 0.5e-3;
    for (int i = 0; i < 5; ++i) {
      ListedPose pose;
      pose.name = "p" + std::to_string(i);
      pose.X_JP.translation().x() = 1e-3 * i;
      if (i != 2) pose.X_JN = needle_in_plane(pose.X_JP, Vec3(0, 0, 10e-3), 0.3).X_JN;
      poses_.push_back(pose);
    }
  }

  [[nodiscard]] Result<SweepResult> run(const std::string& name) const {
    return run_sweep(scene_, poses_, folder_ / name, options_);
  }

  /// Every file below a folder with its content.
  [[nodiscard]] std::map<std::string, std::string> content(const std::string& name) const {
    std::map<std::string, std::string> files;
    for (const auto& entry : fs::recursive_directory_iterator(folder_ / name)) {
      if (!entry.is_regular_file()) continue;
      std::ifstream in(entry.path(), std::ios::binary);
      files[fs::relative(entry.path(), folder_ / name).string()] =
          std::string(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>());
    }
    return files;
  }

  std::shared_ptr<const Scene> scene_;
  std::vector<ListedPose> poses_;
  SweepOptions options_;
};

TEST_F(Sweep, DrawsEveryPoseWithItsTruth) {
  const auto result = run("a");
  ASSERT_TRUE(result.has_value()) << result.error().to_string();
  EXPECT_EQ(result->drawn, 5U);
  std::ifstream lines(folder_ / "a/truth.jsonl");
  std::string line;
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    ASSERT_TRUE(std::getline(lines, line));
    const auto truth = nlohmann::json::parse(line);
    EXPECT_EQ(truth.at("index"), i);
    EXPECT_EQ(truth.at("name"), poses_[i].name);
    EXPECT_EQ(truth.contains("needle"), i != 2);
    const cv::Mat image = cv::imread(
        (folder_ / "a" / truth.at("image").get<std::string>()).string(), cv::IMREAD_UNCHANGED);
    const cv::Mat labels =
        cv::imread((folder_ / "a" / truth.at("labels_shown").get<std::string>()).string(),
                   cv::IMREAD_UNCHANGED);
    const cv::Mat shadow =
        cv::imread((folder_ / "a" / truth.at("shadow_shown").get<std::string>()).string(),
                   cv::IMREAD_UNCHANGED);
    EXPECT_NEAR(truth.at("contact").at("share").get<double>(), 1, 1e-6);
    EXPECT_EQ(image.size(), labels.size());
    EXPECT_EQ(labels.type(), CV_16UC1);
    EXPECT_EQ(shadow.at<std::uint8_t>(12, 40), 0);    // above the needle
    EXPECT_EQ(shadow.at<std::uint8_t>(60, 40), 255);  // behind bone at 30 mm
    EXPECT_EQ(labels.at<std::uint16_t>(5, 40), kFirstRegion);
  }
  EXPECT_FALSE(std::getline(lines, line));
}

TEST(ContactTruth, NamesTheLinesThatAreLifted) {
  Frame frame;
  frame.contact = {1, 1, 0, 0.25F, 1, 0};
  const nlohmann::json contact = contact_json(frame);
  EXPECT_EQ(contact.at("lifted_lines"), nlohmann::json::parse("[[2, 3], [5, 5]]"));
  EXPECT_NEAR(contact.at("share").get<double>(), 3.25 / 6, 1e-9);
}

TEST_F(Sweep, StoppedAndContinuedGivesTheSameBytesAsInOneGo) {
  ASSERT_TRUE(run("whole").has_value());
  int asked = 0;
  options_.stop = [&] {
    return ++asked > 2;
  };
  const auto first = run("parts");
  ASSERT_TRUE(first.has_value());
  EXPECT_EQ(first->drawn, 2U);
  EXPECT_FALSE(first->complete());
  options_.stop = {};
  options_.settings.n_threads = 1;
  const auto second = run("parts");
  ASSERT_TRUE(second.has_value());
  EXPECT_EQ(second->found, 2U);
  EXPECT_EQ(second->drawn, 3U);
  EXPECT_EQ(content("whole"), content("parts"));
  EXPECT_EQ(run("parts")->drawn, 0U);
}

TEST_F(Sweep, WhatAKilledRunLeftHalfDoneIsDrawnAgain) {
  ASSERT_TRUE(run("whole").has_value());
  const auto expected = content("whole");
  // a line cut short, the picture of a finished one lost, a picture half written
  fs::copy(folder_ / "whole", folder_ / "cut", fs::copy_options::recursive);
  const auto file = folder_ / "cut/truth.jsonl";
  fs::resize_file(file, fs::file_size(file) - 40);
  std::ofstream(folder_ / "cut/frames/part-000004.png") << "half";
  EXPECT_EQ(run("cut")->found, 4U);
  auto actual = content("cut");
  actual.erase("frames/part-000004.png");
  EXPECT_EQ(actual, expected);

  fs::copy(folder_ / "whole", folder_ / "lost", fs::copy_options::recursive);
  fs::remove(folder_ / "lost/frames/000001-labels_shown.png");
  EXPECT_EQ(run("lost")->found, 1U);
  EXPECT_EQ(content("lost"), expected);
}

TEST_F(Sweep, AFolderOfAnotherSweepIsRefusedUnlessRestarted) {
  ASSERT_TRUE(run("a").has_value());
  options_.settings.seed = 7;
  const auto other = run("a");
  ASSERT_FALSE(other.has_value());
  EXPECT_NE(other.error().message.find("settings"), std::string::npos);
  options_.restart = true;
  EXPECT_EQ(run("a")->drawn, 5U);
  options_.restart = false;
  poses_.pop_back();
  EXPECT_FALSE(run("a").has_value());
  options_.settings.persistence = 0.5;
  EXPECT_EQ(run("b").error().code, ErrorCode::invalid);
}

TEST_F(Sweep, AVideoHasAFrameForEachPose) {
  SweepVideoOptions video{options_.transducer, options_.settings, {}, 10, true};
  const auto written = write_sweep_video(scene_, poses_, folder_ / "path.avi", video);
  ASSERT_TRUE(written.has_value()) << written.error().to_string();
  EXPECT_EQ(written->frames, 5U);
  EXPECT_GT(fs::file_size(written->file), 1000U);
  EXPECT_FALSE(fs::exists(folder_ / "path.part.avi"));
  EXPECT_FALSE(write_sweep_video(scene_, poses_, folder_ / "path.gif", video).has_value());
}

}  // namespace
}  // namespace artus
