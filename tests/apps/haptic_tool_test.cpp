// SPDX-License-Identifier: AGPL-3.0-or-later
// The commands that render force, as a user meets them: exit codes, messages, figures.
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "artus/detail/apps/commands.h"
#include "tests/apps/run_tool.h"

namespace artus {
namespace {

using test::artus;
using test::kSimple;

/// What the tool says to a command line that it refuses, before anything is run; empty when it
/// takes it. In this process: a hundred of them take no longer than one start of the tool.
std::string refusal(const std::vector<const char*>& line) {
  ExitCode code = ExitCode::ok;
  Command app("artus");
  add_serve_command(app, code);
  int mistake = 0;
  ::testing::internal::CaptureStderr();
  const bool taken = app.parse(static_cast<int>(line.size()), line.data(), mistake);
  std::string said = ::testing::internal::GetCapturedStderr();
  return taken || mistake == 0 ? "" : said;
}

/// The hands alone in the ball of tissues, for `seconds`.
std::vector<std::string> hands(const char* seconds, const std::vector<std::string>& more = {}) {
  std::vector<std::string> line{"serve",     "--no-images", "--input", "injection",
                                "--seconds", seconds,       "--json"};
  line.insert(line.end(), more.begin(), more.end());
  return line;
}

TEST(HapticTool, HandsAloneReportTheirHistogramsWithoutAJoint) {
  const auto run = artus(hands("0.5", {"--haptic-rate", "2000"}));
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto report = nlohmann::json::parse(run.out);
  const auto ticks = report.at("ticks").get<long>();
  EXPECT_GT(ticks, 0);
  EXPECT_LE(ticks, 1100);
  EXPECT_EQ(report.at("rate_hz"), 2000);
  const auto& times = report.at("times");
  EXPECT_EQ(times.at("haptic_compute").at("count").get<long>(), ticks);
  EXPECT_GE(times.at("haptic_lateness").at("count").get<long>(), ticks);
  EXPECT_GT(times.at("haptic_floor").at("count").get<long>(), 0);
  EXPECT_GT(times.at("haptic_fixed_work").at("p50_ms").get<double>(), 1e-4);
  EXPECT_TRUE(report.at("refused").is_array());
  for (const char* count : {"faults", "rested", "inserted", "on_bone"})
    EXPECT_GE(report.at(count).get<long>(), 0) << count;
}

TEST(HapticTool, ALoopOfBeforeIsTheHandsAlone) {
  const auto run = artus(
      {"loop", "--seconds", "0.2", "--rate", "2000", "--cpu", "0", "--priority", "0", "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_NE(run.err.find("'artus serve --no-images'"), std::string::npos) << run.err;
  EXPECT_EQ(nlohmann::json::parse(run.out).at("rate_hz"), 2000);
}

TEST(HapticTool, AServedSessionOfADeviceNeedsAJoint) {
  const auto run = artus({"serve", "--seconds", "0.1"});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_NE(run.err.find("--joint"), std::string::npos) << run.err;
}

TEST(HapticTool, HandsTakeLawsForAllTissuesAndForOne) {
  const auto run =
      artus(hands("0.1", {"--cutting", "voigt", "--cutting", "skin=spring", "--prepuncture",
                          "barbe", "--bone-tap", "impulse", "--clamping", "plasticity",
                          "--friction-set", "1", "--patient", "friction=1.5"}));
  EXPECT_EQ(run.exit_code, 0) << run.err;
}

TEST(HapticTool, HandsTakeAWorkspaceAndThePassivityController) {
  const auto run = artus(hands("0.1", {"--workspace-mm", "0", "0", "60", "100",
                                       "--workspace-push-n", "2", "--passivity-control"}));
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_GT(nlohmann::json::parse(run.out).at("max_force_n").get<double>(), 0);
  for (const char* radius : {"0", "-5", "nan", "inf"}) {
    const auto refused = artus(hands("0.1", {"--workspace-mm", "0", "0", "60", radius}));
    EXPECT_EQ(refused.exit_code, 2) << radius;
    EXPECT_NE(refused.err.find("--workspace-mm"), std::string::npos) << refused.err;
  }
}

TEST(HapticTool, NumbersThatMakeNoSenseAreRefusedAtTheFlag) {
  for (const char* flag : {"--haptic-rate", "--seconds", "--speed-mm-s", "--haptic-cpu",
                           "--haptic-priority", "--friction-set", "--workspace-push-n"}) {
    for (const char* value :
         {"nan", "inf", "-inf", "-5", "1e300", "99999999999999999999", "abc", ""}) {
      const std::string said = refusal({"artus", "serve", flag, value});
      EXPECT_NE(said.find(flag), std::string::npos) << flag << " '" << value << "' " << said;
    }
  }
  const auto run = artus({"serve", "--no-images", "--haptic-rate", "nan"});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_NE(run.err.find("--haptic-rate"), std::string::npos) << run.err;
}

TEST(HapticTool, ANeedlesLengthIsOneNumberForFlowForceAndPicture) {
  const auto length = [](const std::vector<std::string>& flags) {
    std::vector<std::string> all{"inject",  "-j",
                                 kSimple,   "--volume-ml",
                                 "0.1",     "--rate",
                                 "0.5",     "--aspirate",
                                 "0",       "--no-images",
                                 "--rigid", "--json",
                                 "--out",   ::testing::TempDir() + "artus-inject-length"};
    all.insert(all.end(), flags.begin(), flags.end());
    const auto run = artus(all);
    EXPECT_FALSE(run.out.empty()) << run.err;
    return run.out.empty() ? 0 : nlohmann::json::parse(run.out).at("needle_mm").get<double>();
  };
  EXPECT_EQ(length({}), 50);
  EXPECT_EQ(length({"--needle-length-mm", "80"}), 80);
  EXPECT_EQ(length({"--length-mm", "80"}), 80);
}

TEST(HapticTool, TheTestOfThreeInjectionsTakesNoPoseThatItDoesNotUse) {
  for (const char* flag : {"--probe", "--needle"}) {
    const auto run = artus({"run", "three-injections", "-j", kSimple, "--out", "out", flag, "1"});
    EXPECT_EQ(run.exit_code, 2) << flag;
    EXPECT_NE(run.err.find(flag), std::string::npos) << run.err;
  }
}

TEST(HapticTool, LawsListsEveryParameterWithUnitAndSource) {
  const auto run = artus({"laws", "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto json = nlohmann::json::parse(run.out);
  EXPECT_GE(json.at("laws").size(), 19U);
  for (const auto& law : json.at("laws")) {
    EXPECT_FALSE(law.at("source").get<std::string>().empty()) << law;
    for (const auto& parameter : law.at("parameters")) {
      EXPECT_FALSE(parameter.at("unit").get<std::string>().empty()) << parameter;
      EXPECT_FALSE(parameter.at("source").get<std::string>().empty()) << parameter;
    }
  }
  EXPECT_GE(json.at("tissues").size(), 6U);
  const auto one = artus({"laws", "voigt"});
  EXPECT_NE(one.out.find("5 N s/m"), std::string::npos) << one.out;
  const auto none = artus({"laws", "butter"});
  EXPECT_EQ(none.exit_code, 1);
  EXPECT_NE(none.err.find("tracking_wall"), std::string::npos) << none.err;
}

TEST(HapticTool, AnUnknownLawTissueOrFactorIsRefusedWithWhatThereIs) {
  const auto law = artus(hands("0.1", {"--cutting", "butter"}));
  EXPECT_EQ(law.exit_code, 2);
  EXPECT_NE(law.err.find("tracking_wall, direct, spring, voigt"), std::string::npos) << law.err;
  const auto tissue = artus(hands("0.1", {"--cutting", "butter=voigt"}));
  EXPECT_EQ(tissue.exit_code, 2);
  EXPECT_NE(tissue.err.find("muscle"), std::string::npos) << tissue.err;
  const auto factor = artus(hands("0.1", {"--patient", "friction=-1"}));
  EXPECT_EQ(factor.exit_code, 2);
  EXPECT_NE(factor.err.find("friction=-1"), std::string::npos) << factor.err;
  const auto rate = artus(hands("0.1", {"--haptic-rate", "1e9"}));
  EXPECT_EQ(rate.exit_code, 2);
}

}  // namespace
}  // namespace artus
