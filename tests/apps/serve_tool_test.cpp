// SPDX-License-Identifier: AGPL-3.0-or-later
// `artus serve` as a process: how it ends, and that what it recorded replays for any flags.
#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <sys/wait.h>
#include <unistd.h>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "artus/detail/session/session_thread.h"
#include "artus/detail/session/shm/shared_memory.h"
#include "tests/apps/run_tool.h"

namespace artus {
namespace {

using test::start_tool;

class ServeProcess : public ::testing::TestWithParam<int> {
 protected:
  ~ServeProcess() override {
    for (const SegmentLayout& layout : {kPosLayout, kForceLayout, kImageLayout})
      SharedSegment::remove(prefix_, layout);
  }
  [[nodiscard]] bool exists(const char* name) const {
    return std::filesystem::exists("/dev/shm/" + prefix_ + name);
  }
  std::string prefix_ = "artus-serve-" + std::to_string(getpid()) + "-";
};

TEST_P(ServeProcess, EndsByASignalInGoodOrder) {
  const pid_t process = start_tool({"serve", "-j", test::kSimple, "--rigid", "--prefix", prefix_});
  const std::int64_t patience = monotonic_ns() + 60'000'000'000;
  while (!exists("IMAGE") && monotonic_ns() < patience) usleep(10'000);
  auto seen = SharedChannel<artus_shm_force>::open(prefix_, kForceLayout, SegmentAccess::observer);
  ASSERT_TRUE(seen) << seen.error().to_string();
  artus_shm_force force{};
  while ((!seen->read(force) || force.tick < 50) && monotonic_ns() < patience) usleep(1000);
  ASSERT_GE(force.tick, 50U);
  kill(process, GetParam());
  int status = 0;
  waitpid(process, &status, 0);
  EXPECT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 0);
  ASSERT_TRUE(seen->read(force));
  EXPECT_EQ(force.status, static_cast<std::uint32_t>(ARTUS_SHM_STOPPED));
  for (const double f : force.force) EXPECT_EQ(f, 0);
  for (const char* name : {"POS", "FORCE", "IMAGE"}) EXPECT_FALSE(exists(name)) << name;
}

INSTANTIATE_TEST_SUITE_P(Signals, ServeProcess, ::testing::Values(SIGINT, SIGTERM, SIGHUP),
                         [](const auto& number) {
                           return std::string(sigabbrev_np(number.param));
                         });

TEST(Serve, WithoutImagesMakesNoSegmentAndDrawsNothing) {
  const auto served = test::artus({"serve", "-j", test::kSimple, "--input", "injection",
                                   "--no-images", "--seconds", "0.3", "--json"});
  EXPECT_EQ(served.exit_code, 0) << served.err;
  EXPECT_NE(served.out.find("\"frames\": 0"), std::string::npos);
}

TEST(Serve, SaysWhatASessionInTissueThatGivesWayCostsHere) {
  const auto served =
      test::artus({"serve", "-j", test::kSimple, "--input", "injection", "--prefix",
                   "artus-cost-" + std::to_string(getpid()) + "-", "--seconds", "20", "--json"});
  ASSERT_EQ(served.exit_code, 0) << served.err;
  const auto report = nlohmann::json::parse(served.out);
  EXPECT_GT(report.at("peak_memory_mb").get<double>(), 50);
  const auto& times = report.at("times");
  for (const char* what : {"haptic_compute", "tissue_step", "tissue_interval", "image_render",
                           "image_interval", "fixed_work"}) {
    EXPECT_GT(times.at(what).at("count").get<int>(), 1) << what;
    EXPECT_GT(times.at(what).at("p50_ms").get<double>(), 0) << what;
    EXPECT_GE(times.at(what).at("p99_ms").get<double>(), times.at(what).at("p50_ms").get<double>());
  }
}

TEST(Serve, NumbersThatCannotBeWrittenAreRefusedBeforeTheSession) {
  for (const char* command : {"serve", "view"}) {
    const auto refused =
        test::artus({command, "-j", test::kSimple, "--rigid", "--metrics", "/proc/live.json"});
    EXPECT_NE(refused.exit_code, 0) << command;
    EXPECT_NE(refused.err.find("/proc/live.json"), std::string::npos) << refused.err;
  }
}

TEST(Assess, TakesTheNeedlesThatThereAre) {
  const std::filesystem::path list = std::filesystem::path(testing::TempDir()) / "gauges.csv";
  std::ofstream(list) << "time_s,entry_x_mm,entry_y_mm,entry_z_mm,tip_x_mm,tip_y_mm,tip_z_mm\n"
                         "0,0,0,-10,0,0,10\n1,0,0,-10,0,0,12\n";
  const auto with = [&](const char* gauge) {
    return test::artus(
        {"assess", "--poses", list.string(), "-j", test::kSimple, "--gauge", gauge, "--json"});
  };
  EXPECT_EQ(with("27").exit_code, 0);
  const auto refused = with("24");
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_NE(refused.err.find("23, 25 or 27"), std::string::npos) << refused.err;
}

TEST(Serve, RefusesAPrefixThatIsNone) {
  const auto served = test::artus({"serve", "-j", test::kSimple, "--prefix", "a/b"});
  EXPECT_EQ(served.exit_code, 2);
  EXPECT_NE(served.err.find("63 letters"), std::string::npos);
}

/// A flag of `serve` away from its default.
struct Flag {
  const char* name;
  std::vector<std::string> arguments;
};

class ServeFlag : public ::testing::TestWithParam<Flag> {};

TEST_P(ServeFlag, RecordsWhatReplaysToTheSameBytes) {
  const auto file = std::filesystem::temp_directory_path() /
                    ("artus-flag-" + std::to_string(getpid()) + GetParam().name + ".rec");
  std::vector<std::string> serve{
      "serve",        "-j",        test::kSimple, "--rigid",
      "--input",      "injection", "--record",    file,
      "--speed-mm-s", "60",        "--seconds",   "1.2",
      "--image-rate", "5",         "--prefix",    "artus-flag-" + std::to_string(getpid()) + "-"};
  const auto& more = GetParam().arguments;
  serve.insert(serve.end(), more.begin(), more.end());
  const auto served = test::artus(serve);
  ASSERT_EQ(served.exit_code, 0) << served.err;
  const auto trace = file.string() + ".csv";
  const auto replayed =
      test::artus({"replay", file, "-j", test::kSimple, "--trace", trace, "--json"});
  EXPECT_EQ(replayed.exit_code, 0) << replayed.out << replayed.err;
  EXPECT_NE(replayed.out.find("\"identical\": true"), std::string::npos);
  EXPECT_EQ(replayed.out.find("\"ticks\": 0"), std::string::npos);
  std::string head;
  std::ifstream lines(trace);
  std::getline(lines, head);
  for (const char* column :
       {"cutting_n",       "friction_n",        "hard_n",       "clamping_x_n",
        "surface_z_n",     "workspace_y_n",     "contact",      "region",
        "plunger_mm",      "thumb_n",           "pressure_kpa", "tip_pressure_kpa",
        "flow_ml_s",       "given_ml",          "drawn_ml",     "plunger_status",
        "probe_force_z_n", "probe_torque_x_nm", "probe_share",  "probe_status"})
    EXPECT_NE(head.find(column), std::string::npos) << column;
  std::string line;
  while (std::getline(lines, line))
    ASSERT_EQ(std::count(line.begin(), line.end(), ','), std::count(head.begin(), head.end(), ','))
        << line;
  std::filesystem::remove(file);
  std::filesystem::remove(trace);
}

INSTANTIATE_TEST_SUITE_P(
    Flags, ServeFlag,
    ::testing::Values(
        Flag{"Default", {}}, Flag{"Device", {"--device", "delta"}},
        Flag{"HapticRate", {"--haptic-rate", "700"}}, Flag{"ImageRate", {"--threads", "1"}},
        Flag{"Cutting", {"--cutting", "voigt", "--cutting", "skin=direct"}},
        Flag{"Prepuncture", {"--prepuncture", "simone_okamura"}},
        Flag{"BoneTap", {"--bone-tap", "impulse"}}, Flag{"Clamping", {"--clamping", "plasticity"}},
        Flag{"FrictionSet", {"--friction-set", "1"}},
        Flag{"Patient", {"--patient", "cutting=1.3", "--patient", "friction=0.7"}},
        Flag{"Workspace", {"--workspace-mm", "0", "0", "0", "200", "--workspace-push-n", "0.5"}},
        Flag{"Passivity", {"--passivity-control"}},
        Flag{"NeedleLength", {"--needle-length-mm", "50"}}, Flag{"Injection", {"--injection", "2"}},
        Flag{"Gauge", {"--gauge", "25"}}, Flag{"Liquid", {"--liquid", "blood"}},
        Flag{"Syringe", {"--syringe-ml", "2", "--give-ml", "0.1"}},
        Flag{"NoImages", {"--no-images"}}, Flag{"HapticCpu", {"--haptic-cpu", "0"}}),
    [](const auto& flag) { return std::string(flag.param.name); });

}  // namespace
}  // namespace artus
