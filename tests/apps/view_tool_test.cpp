// SPDX-License-Identifier: AGPL-3.0-or-later
// `artus view` as a process: what its flags refuse before anything is shown, and that what it
// recorded replays for its flags and for the knobs that were turned.
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

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
  // NOLINTNEXTLINE(*-command-processor,*-mt-unsafe): before any thread is started
  if (std::system("command -v xvfb-run >/dev/null") != 0)
    GTEST_SKIP() << "xvfb-run is not installed";
  const std::vector<Shown> all{{"Feel",
                                {"--cutting", "voigt", "--bone-tap", "impulse", "--patient",
                                 "cutting=1.3", "--needle-length-mm", "50", "--device", "delta"}},
                               {"Rates", {"--haptic-rate", "700", "--image-rate", "11"}},
                               {"Window",
                                {"--expert", "--plain", "--left-handed", "--font-scale", "1.5",
                                 "--window-rate", "7", "--language", "fr"}},
                               {"Knobs", {}, "wait 0.4\nkey G\nkey G\nkey D\nwait 0.4\n"}};
  for (const Shown& shown : all) {
    SCOPED_TRACE(shown.name);
    expect_replays(shown);
  }
}

}  // namespace
}  // namespace artus
