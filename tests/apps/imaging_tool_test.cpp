// SPDX-License-Identifier: AGPL-3.0-or-later
// The commands that draw, as a user meets them: exit codes, messages, files.
#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include <opencv2/imgcodecs.hpp>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/apps/run_tool.h"
#include "tests/support/paths.h"
#include "tests/support/temporary_folder.h"

namespace artus {
namespace {

using test::artus;
using test::kSimple;

class ImagingTool : public test::TemporaryFolder {
 protected:
  /// Three poses beside the joint's own, the last with a needle.
  std::string poses(int count = 3) const {
    const auto image = artus({"image", "-j", kSimple, "-o", in("pose.png"), "--json"});
    const auto probe = nlohmann::json::parse(image.out).at("probe");
    std::ofstream out(folder_ / "poses.jsonl");
    for (int i = 0; i < count; ++i) {
      nlohmann::json pose{{"probe", probe}, {"name", "pose " + std::to_string(i)}, {"time_s", i}};
      pose["probe"]["position_mm"][2] = probe.at("position_mm")[2].get<double>() + i;
      if (i == 2) pose["needle"] = {{"entry_mm", {60, 0, 0}}, {"tip_mm", {40, 0, 0}}};
      out << pose << '\n';
    }
    return in("poses.jsonl");
  }
};

TEST_F(ImagingTool, AnImageOfNothingIsRefusedWithAProbeThatStands) {
  const auto nothing =
      artus({"image", "-j", kSimple, "--probe=-90,0,0/1,0,0", "-o", in("nothing.png")});
  EXPECT_EQ(nothing.exit_code, 2);
  EXPECT_FALSE(std::filesystem::exists(in("nothing.png")));
  const auto at = nothing.err.find("--probe=");
  ASSERT_NE(at, std::string::npos) << nothing.err;
  const std::string probe = nothing.err.substr(at, nothing.err.find(' ', at) - at);
  const auto image = artus({"image", "-j", kSimple, probe, "-o", in("skin.png"), "--json"});
  ASSERT_EQ(image.exit_code, 0) << probe << image.err;
  EXPECT_GT(nlohmann::json::parse(image.out).at("contact").at("share").get<double>(), 0.2);
}

TEST_F(ImagingTool, DrawsAnImageAnEnvelopeAndTheLabelsBesideIt) {
  const auto image = artus({"image", "-j", kSimple, "--needle", "default", "-o", in("b.png"),
                            "--plain", "--envelope", in("e.tiff"), "--json"});
  ASSERT_EQ(image.exit_code, 0) << image.err;
  EXPECT_TRUE(nlohmann::json::parse(image.out).contains("needle"));
  const auto slice = artus(
      {"image", "labels", "-j", kSimple, "-o", in("l.png"), "--ids", in("ids.png"), "--json"});
  ASSERT_EQ(slice.exit_code, 0) << slice.err;
  const auto regions = nlohmann::json::parse(slice.out).at("regions");
  EXPECT_GE(regions.size(), 4U);
  EXPECT_EQ(regions[0].at("rgb").size(), 3U);
  const cv::Mat bmode = cv::imread(in("b.png"), cv::IMREAD_UNCHANGED);
  const cv::Mat ids = cv::imread(in("ids.png"), cv::IMREAD_UNCHANGED);
  EXPECT_EQ(bmode.size(), ids.size());
  EXPECT_EQ(ids.type(), CV_16UC1);
  EXPECT_EQ(cv::imread(in("e.tiff"), cv::IMREAD_UNCHANGED).type(), CV_32FC1);
}

TEST_F(ImagingTool, TheImageIsTheSameAtAnyNumberOfThreads) {
  std::vector<cv::Mat> images;
  for (const char* threads : {"1", "2", "7"}) {
    const auto r = artus(
        {"image", "-j", kSimple, "--needle", "default", "-o", in("b.png"), "--threads", threads});
    ASSERT_EQ(r.exit_code, 0) << r.err;
    images.push_back(cv::imread(in("b.png"), cv::IMREAD_UNCHANGED));
  }
  for (const auto& image : images) EXPECT_EQ(cv::norm(image, images[0], cv::NORM_INF), 0);
}

TEST_F(ImagingTool, ATransducerComesByNameOrFromAFile) {
  const std::string file =
      artus::test::source_dir().string() + "/devices/transducers/curved-2-5.toml";
  for (const std::string& transducer : {std::string("curved-2-5"), file}) {
    const auto r = artus({"image", "-j", kSimple, "--transducer", transducer, "--depth", "60", "-o",
                          in("b.png"), "--json"});
    ASSERT_EQ(r.exit_code, 0) << r.err;
    EXPECT_EQ(nlohmann::json::parse(r.out).at("transducer").at("radius_mm"), 60);
  }
  const auto unknown = artus({"image", "-j", kSimple, "--transducer", "linear", "-o", in("b.png")});
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_NE(unknown.err.find("hockey-7-15"), std::string::npos);
  std::ofstream(folder_ / "bad.toml") << "format = 1\nname = \"bad\"\nwidth_mm = 1e9\n";
  const auto bad =
      artus({"image", "-j", kSimple, "--transducer", in("bad.toml"), "-o", in("b.png")});
  EXPECT_EQ(bad.exit_code, 1);
  EXPECT_NE(bad.err.find("width_mm"), std::string::npos);
  EXPECT_NE(bad.err.find("bad.toml"), std::string::npos);
}

TEST_F(ImagingTool, RefusesAFlagOutOfItsRangeInItsOwnUnits) {
  for (const auto& [flag, value] : {std::pair("--depth", "0"),
                                    {"--lines", "10000"},
                                    {"--frequency", "1e9"},
                                    {"--compound", "4"},
                                    {"--planes", "0"},
                                    {"--steering", "50"},
                                    {"--pixel", "0"}}) {
    const auto r = artus({"image", "-j", kSimple, flag, value, "-o", in("b.png")});
    EXPECT_EQ(r.exit_code, 2) << flag;
    EXPECT_NE(r.err.find(flag), std::string::npos) << r.err;
  }
  const auto nan = artus({"image", "-j", kSimple, "--depth", "nan", "-o", in("b.png")});
  EXPECT_EQ(nan.exit_code, 2);
  EXPECT_NE(nan.err.find("depth"), std::string::npos) << nan.err;
}

TEST_F(ImagingTool, DopplerColoursAMovingNeedle) {
  const auto coloured = [&](const char* speed) {
    const auto r = artus({"image", "-j", kSimple, "--needle", "default", "--doppler", speed, "-o",
                          in("d.png"), "--json"});
    EXPECT_EQ(r.exit_code, 0) << r.err;
    std::vector<cv::Mat> channels;
    cv::split(cv::imread(in("d.png")), channels);
    return cv::countNonZero(channels[0] != channels[2]);
  };
  EXPECT_EQ(coloured("0"), 0);
  EXPECT_GT(coloured("-40"), 10);
}

TEST_F(ImagingTool, APhantomComesWithItsTruth) {
  const auto r =
      artus({"image", "phantom", "needle", "--needle-angle", "30", "--out", in("n"), "--json"});
  ASSERT_EQ(r.exit_code, 0) << r.err;
  EXPECT_NEAR(nlohmann::json::parse(r.out).at("needle").at("face_angle_deg").get<double>(), 30,
              1e-6);
  for (const char* file :
       {"bmode.png", "grey.png", "envelope.tiff", "labels.png", "ids.png", "truth.json"})
    EXPECT_TRUE(std::filesystem::exists(folder_ / "n" / file)) << file;
  EXPECT_EQ(artus({"image", "phantom", "brick", "--out", in("x")}).exit_code, 2);
  EXPECT_EQ(
      artus({"image", "phantom", "needle", "--needle-angle", "89", "--out", in("x")}).exit_code, 2);
}

TEST_F(ImagingTool, APressedJointHasForcesLayersAndACage) {
  const auto r = artus({"deform", "-j", kSimple, "--press-n", "1", "--cell-mm", "6", "-o",
                        in("cage.vtu"), "--slice", in("pressed.png"), "--json"});
  ASSERT_EQ(r.exit_code, 0) << r.out << r.err;
  const auto report = nlohmann::json::parse(r.out);
  EXPECT_NEAR(report.at("normal_force_n").get<double>(), 1, 0.01);
  EXPECT_FALSE(report.contains("needle"));
  std::map<std::string, double> thinned;
  for (const auto& layer : report.at("layers"))
    thinned[layer.at("tissue").get<std::string>()] = layer.at("thinned_percent").get<double>();
  EXPECT_GT(thinned.at("muscle"), 5);
  EXPECT_GT(thinned.at("muscle"), thinned.at("tendon"));
  EXPECT_TRUE(std::filesystem::exists(folder_ / "cage.vtu"));
  EXPECT_TRUE(std::filesystem::exists(folder_ / "pressed.png"));
  EXPECT_EQ(artus({"deform", "-j", kSimple, "--press-n", "1", "--press-mm", "1"}).exit_code, 2);
}

/// H2: a default shoulder gives way by 2 to 8 mm under 3 N, fat thins most and tendon least.
TEST_F(ImagingTool, ThreeNewtonsPressAShoulderByWhatFatAndMuscleGiveWay) {
  const auto r = artus({"deform", "-j", (test::test_joints() / "shoulder.artus").string(),
                        "--press-n", "3", "--json"});
  ASSERT_EQ(r.exit_code, 0) << r.out << r.err;
  const auto report = nlohmann::json::parse(r.out);
  EXPECT_TRUE(report.at("settled").get<bool>());
  EXPECT_GE(report.at("depth_mm").get<double>(), 2);
  EXPECT_LE(report.at("depth_mm").get<double>(), 8);
  std::map<std::string, double> thinned;  // the uppermost of each tissue
  for (const auto& layer : report.at("layers"))
    thinned.try_emplace(layer.at("tissue").get<std::string>(),
                        layer.at("thinned_percent").get<double>());
  EXPECT_GT(thinned.at("fat"), thinned.at("muscle"));
  EXPECT_GT(thinned.at("muscle"), thinned.at("tendon"));
  EXPECT_GT(thinned.at("fat"), thinned.at("skin"));
}

TEST_F(ImagingTool, TheFaceOfTheProbeThatIsNamedPressesInPictureAndDeformAlike) {
  const auto newtons = [&](std::vector<std::string> line, const std::string& transducer) {
    line.insert(line.end(),
                {"-j", kSimple, "--transducer", transducer, "--press-mm", "8", "--json"});
    const auto r = artus(line);
    EXPECT_EQ(r.exit_code, 0) << r.err << r.out;
    const auto report = nlohmann::json::parse(r.out);
    return (report.contains("press") ? report["press"] : report).at("normal_force_n").get<double>();
  };
  const std::vector<std::string> picture{"image", "labels", "-o", in("face.png")};
  const double hockey = newtons({"deform"}, "hockey-7-15");
  EXPECT_EQ(hockey, newtons(picture, "hockey-7-15"));
  // 25 mm of face for 40: less force for the same depth, once more of a round skin than the shorter
  // one reaches lies below the plane of the face.
  EXPECT_LT(hockey, 0.9 * newtons(picture, "linear-6-18"));
}

TEST_F(ImagingTool, ACurvedFaceDoesNotPress) {
  const auto drawn = artus({"image", "-j", kSimple, "--transducer", "curved-2-5", "--press-mm", "2",
                            "-o", in("curved.png")});
  EXPECT_EQ(drawn.exit_code, 2);
  EXPECT_NE(drawn.err.find("straight"), std::string::npos) << drawn.err;
  const auto deformed = artus({"deform", "-j", kSimple, "--transducer", "curved-2-5"});
  EXPECT_EQ(deformed.exit_code, 2);
  EXPECT_NE(deformed.err.find("--transducer: only a straight"), std::string::npos) << deformed.err;
}

TEST_F(ImagingTool, APressedPictureSaysWhatWasPressed) {
  for (std::vector<std::string> line : {std::vector<std::string>{"image"}, {"image", "labels"}}) {
    line.insert(line.end(), {"-j", kSimple, "--press-mm", "1", "-o", in("pressed.png")});
    const auto r = artus(line);
    ASSERT_EQ(r.exit_code, 0) << r.err;
    EXPECT_NE(r.out.find("pressed 1.00 mm"), std::string::npos) << r.out;
  }
}

/// What the report of a command says of a needle in a pressed simple-shoulder, moved last in this
/// direction.
nlohmann::json needle_moved(std::vector<std::string> line, const std::string& direction) {
  line.insert(line.end(), {"-j", kSimple, "--press-mm", "1", "--needle", "default", "--needle-way",
                           direction, "--json"});
  const auto r = artus(line);
  EXPECT_EQ(r.exit_code, 0) << r.err << r.out;
  return nlohmann::json::parse(r.out);
}

/// Some seconds a needle: that picture and `deform` agree is asked of one that goes in.
TEST_F(ImagingTool, NeedleThatGoesInPushesTheTissueOnInPictureAndDeformAlike) {
  const auto needle =
      needle_moved({"image", "labels", "-o", in("in.png")}, "in").at("press").at("needle");
  EXPECT_GT(needle.at("tip_force_n").get<double>(), 0);
  EXPECT_GT(needle.at("tissue_moved_mm").get<double>(), 0.1);
  EXPECT_LT(needle.at("tissue_moved_mm").get<double>(), 5);
  EXPECT_TRUE(std::filesystem::exists(in("in.png")));
  // Going in is what a needle does unless told otherwise.
  const auto told = artus({"deform", "-j", kSimple, "--press-mm", "1", "--needle", "default"});
  std::array<char, 96> said{};
  std::snprintf(said.data(), said.size(),
                "needle going in: %.2f N, tissue at its tip moved %.2f mm",
                needle.at("force_n").get<double>(), needle.at("tissue_moved_mm").get<double>());
  EXPECT_NE(told.out.find(said.data()), std::string::npos) << said.data() << told.out;
}

TEST_F(ImagingTool, NeedleDrawnBackPullsTissueAlong) {
  const auto needle = needle_moved({"deform"}, "out").at("needle");
  EXPECT_LE(needle.at("tip_force_n").get<double>(), 0) << "it is drawn out, and pulls";
  EXPECT_LT(needle.at("force_n").get<double>(), 0);
  EXPECT_LT(needle.at("tissue_moved_mm").get<double>(), -0.02);
}

TEST_F(ImagingTool, ADirectionWithoutANeedleIsRefused) {
  const auto without = artus({"deform", "-j", kSimple, "--needle-way", "in"});
  EXPECT_EQ(without.exit_code, 2);
  EXPECT_NE(without.err.find("--needle-direction: needs a needle"), std::string::npos)
      << without.err;
}

TEST_F(ImagingTool, ASeedThatIsNoWholeNumberIsRefusedWithItsRange) {
  for (const char* seed : {"-1", "1e9", "2000000000"}) {
    const auto r = artus({"image", "-j", kSimple, "--seed", seed, "-o", in("seed.png")});
    EXPECT_EQ(r.exit_code, 2) << seed;
    EXPECT_NE(r.err.find("is not a whole number from 0 to 1000000000"), std::string::npos) << r.err;
  }
}

TEST_F(ImagingTool, NeedleDragsNothingInARigidBody) {
  const auto r = artus({"image", "labels", "-j", kSimple, "--needle", "default", "--needle-way",
                        "in", "-o", in("rigid.png")});
  EXPECT_EQ(r.exit_code, 2);
  EXPECT_NE(r.err.find("--press-n"), std::string::npos) << r.err;
}

TEST_F(ImagingTool, ASweepContinuesAndAVideoFollowsThePath) {
  const std::string list = poses();
  const std::vector<std::string> sweep{"sweep", "-j",    kSimple, "--poses",
                                       list,    "--out", in("s"), "--json"};
  const auto first = artus(sweep);
  ASSERT_EQ(first.exit_code, 0) << first.out << first.err;
  EXPECT_EQ(nlohmann::json::parse(first.out).at("drawn"), 3);
  std::filesystem::remove(folder_ / "s/frames/000002.png");
  EXPECT_EQ(nlohmann::json::parse(artus(sweep).out).at("drawn"), 1);
  poses(2);
  const auto other = artus(sweep);
  EXPECT_EQ(other.exit_code, 1);
  EXPECT_NE(other.err.find("--restart"), std::string::npos);

  poses();
  const auto video = artus(
      {"image", "video", "-j", kSimple, "--path", list, "--fps", "5", "-o", in("p.avi"), "--json"});
  ASSERT_EQ(video.exit_code, 0) << video.out << video.err;
  EXPECT_EQ(nlohmann::json::parse(video.out).at("frames"), 11);
  EXPECT_GT(std::filesystem::file_size(folder_ / "p.avi"), 10000U);
  EXPECT_EQ(
      artus({"sweep", "-j", kSimple, "--poses", in("absent.csv"), "--out", in("t")}).exit_code, 1);
}

}  // namespace
}  // namespace artus
