// SPDX-License-Identifier: AGPL-3.0-or-later
// `artus view` as a process: what its flags refuse before anything is shown, and that what it
// recorded replays for its flags and for the knobs that were turned.
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include <gtest/gtest.h>

#include "artus/session/recording.h"
#include "tests/apps/run_tool.h"

namespace artus {
namespace {

TEST(View, SizesAndRatesThatAreNoneAreRefusedAtTheFlag) {
  const std::vector<std::vector<std::string>> wrong{
      {"--width", "0"},     {"--height", "-5"},       {"--window-rate", "0"},
      {"--width", "nan"},   {"--font-scale", "100"},  {"--pixels-per-mm", "-1"},
      {"--language", "de"}, {"--window-rate", "nan"}, {"--height", "1e9"}};
  for (const auto& flag : wrong) {
    const auto result = test::artus({"view", "-j", test::kSimple, flag[0], flag[1]});
    EXPECT_EQ(result.exit_code, 2) << flag[0] << ' ' << flag[1];
    EXPECT_NE(result.err.find(flag[0]), std::string::npos) << result.err;
  }
}

TEST(View, AnInjectionThatIsNotThereIsRefusedWithEveryInput) {
  for (const char* input : {"hand", "shared-memory", "injection"}) {
    for (const char* which : {"0", "9"}) {
      const auto result =
          test::artus({"view", "-j", test::kSimple, "--input", input, "--injection", which});
      EXPECT_NE(result.exit_code, 0) << input << ' ' << which;
      EXPECT_NE(result.err.find("--injection"), std::string::npos) << result.err;
    }
  }
}

TEST(View, AnInjectionIsChosenWithEveryInput) {
  if (!test::has_virtual_display()) GTEST_SKIP() << "xvfb-run is not installed";
  const auto joint = read_compiled_joint(test::kSimple);
  ASSERT_TRUE(joint) << joint.error().to_string();
  const auto stem =
      std::filesystem::temp_directory_path() / ("artus-plan-" + std::to_string(getpid()));
  const std::string script = stem.string() + ".script";
  std::ofstream(script) << "wait 0.2\n";
  for (const char* input : {"hand", "injection"}) {
    constexpr std::size_t which = 1;  // enters where the first does, in a direction 0.34 apart
    const std::string file = stem.string() + ".rec";
    const auto viewed = test::run_process(
        {"xvfb-run", "-a", ARTUS_TOOL, "view", "-j", test::kSimple, "--input", input, "--injection",
         std::to_string(which + 1), "--record", file, "--script", script, "--rigid"});
    ASSERT_EQ(viewed.exit_code, 0) << viewed.err;
    const auto recording = read_recording(file);
    ASSERT_TRUE(recording) << recording.error().to_string();
    ASSERT_FALSE(recording->ticks.empty());
    const PlannedInjection& plan = joint->injections[which];
    const Vec3 axis = (plan.target - plan.entry).normalized();
    const Pose X_WN = to_pose(recording->ticks.back().input.device.X_WN);
    EXPECT_LT((X_WN.linear().col(2) - axis).norm(), 0.05) << input << ' ' << which;
    std::filesystem::remove(file);
  }
  std::filesystem::remove(script);
}

TEST(View, WithoutADisplayItSaysWhatToDoForAPersonAndForCi) {
  const auto result = test::run_process({"env", "-u", "DISPLAY", "-u", "WAYLAND_DISPLAY",
                                         ARTUS_TOOL, "view", "-j", test::kSimple, "--rigid"});
  EXPECT_NE(result.exit_code, 0);
  EXPECT_NE(result.err.find("graphical session"), std::string::npos) << result.err;
  EXPECT_NE(result.err.find("xvfb-run"), std::string::npos) << result.err;
}

TEST(View, AScreenshotWithoutAScriptIsOnePictureOfAWholeWindowAndTheEnd) {
  if (!test::has_virtual_display()) GTEST_SKIP() << "xvfb-run is not installed";
  const auto file =
      std::filesystem::temp_directory_path() / ("artus-shot-" + std::to_string(getpid()) + ".png");
  const auto result = test::run_process({"timeout", "60", "xvfb-run", "-a", ARTUS_TOOL, "view",
                                         "-j", test::kSimple, "--rigid", "--width", "1000",
                                         "--height", "600", "--screenshot", file.string()});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const cv::Mat picture = cv::imread(file.string(), cv::IMREAD_GRAYSCALE);
  ASSERT_EQ(picture.size(), cv::Size(1000, 600));
  const auto detail = [&picture](const cv::Rect& place) {
    cv::Mat mean;
    cv::Mat deviation;
    cv::meanStdDev(picture(place), mean, deviation);
    return deviation.at<double>(0);
  };
  EXPECT_GT(detail({100, 130, 180, 180}), 10) << "the 3D view is in it";
  EXPECT_GT(detail({440, 130, 180, 180}), 10) << "the B-mode image is in it";
  std::filesystem::remove(file);
}

/// Flags of `view` away from their defaults, and keys of its window.
struct Shown {
  const char* name;
  std::vector<std::string> arguments;
  const char* script = "wait 0.8\n";
};

void expect_replays(const Shown& shown) {
  const auto file = std::filesystem::temp_directory_path() /
                    ("artus-view-" + std::to_string(getpid()) + shown.name + ".rec");
  const auto script = file.string() + ".script";
  std::ofstream(script) << shown.script;
  std::vector<std::string> view{"xvfb-run",    "-a",      ARTUS_TOOL,  "view",         "-j",
                                test::kSimple, "--input", "injection", "--speed-mm-s", "60",
                                "--record",    file,      "--script",  script,         "--rigid"};
  const auto& more = shown.arguments;
  view.insert(view.end(), more.begin(), more.end());
  const auto viewed = test::run_process(view);
  ASSERT_EQ(viewed.exit_code, 0) << viewed.err;
  const auto replayed = test::artus({"replay", file, "-j", test::kSimple, "--json"});
  EXPECT_EQ(replayed.exit_code, 0) << replayed.out << replayed.err;
  EXPECT_NE(replayed.out.find("\"identical\": true"), std::string::npos);
  EXPECT_EQ(replayed.out.find("\"ticks\": 0"), std::string::npos);
  EXPECT_EQ(replayed.out.find("\"frames\": 0"), std::string::npos);
  std::filesystem::remove(file);
  std::filesystem::remove(script);
}

// One after the other: two virtual displays that begin at once may take the same number.
TEST(View, RecordsWhatReplaysToTheSameBytesForFlagsAndKnobs) {
  if (!test::has_virtual_display()) GTEST_SKIP() << "xvfb-run is not installed";
  const std::vector<Shown> all{
      {"FeelAndWindow",
       {"--cutting", "voigt", "--bone-tap", "impulse", "--patient", "cutting=1.3",
        "--needle-length-mm", "50", "--device", "delta", "--expert", "--plain", "--left-handed",
        "--font-scale", "1.5", "--window-rate", "7", "--language", "fr"}},
      {"RatesAndKnobs",
       {"--haptic-rate", "700", "--image-rate", "11"},
       "wait 0.4\nkey G\nkey G\nkey D\nwait 0.4\n"}};
  for (const Shown& shown : all) {
    SCOPED_TRACE(shown.name);
    expect_replays(shown);
  }
}

}  // namespace
}  // namespace artus
