// SPDX-License-Identifier: AGPL-3.0-or-later
// What the tool was silent about, or did without end: each is told now, with an exit code.
#include <filesystem>
#include <fstream>
#include <string>

#include <gmock/gmock.h>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/anatomy/compile/joint_folder.h"
#include "tests/apps/run_tool.h"

namespace artus {
namespace {

using test::artus;
using test::JointFolder;
using test::kSimple;
using testing::HasSubstr;

class Refusals : public testing::Test {
 protected:
  Refusals() { std::filesystem::create_directories(folder_); }
  ~Refusals() override {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }
  [[nodiscard]] std::string in(const std::string& name) const { return (folder_ / name).string(); }
  std::string file(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return in(name);
  }
  std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() / ("artus-refusals-" + std::to_string(getpid()));
};

TEST_F(Refusals, ABodyThatNothingHoldsIsRefusedByEveryCommandThatWouldPushIt) {
  JointFolder boneless("boneless-tool");
  boneless.add_sphere("body", Vec3(0, 0, 0), 30);
  boneless.add_sphere("head", Vec3(0, 0, 5), 8);
  boneless.write_toml("[[structure]]\nname = \"head\"\ntissue = \"muscle\"\nfile = \"head.ply\"\n");
  const std::string joint = boneless.path().string();
  for (const auto& line : std::vector<std::vector<std::string>>{
           {"check", joint},
           {"compile", joint, "-o", in("b.artus"), "--cache", in("cache")},
           {"deform", "-j", joint, "--press-mm", "1", "--cache", in("cache")},
           {"image", "strain", "-j", joint, "-o", in("s.png"), "--cache", in("cache")},
           {"image", "-j", joint, "--press-n", "1", "-o", in("i.png"), "--cache", in("cache")},
           {"serve", "-j", joint, "--input", "injection", "--entry=0,0,30", "--target=0,0,16",
            "--seconds", "1", "--cache", in("cache")}}) {
    const auto run = artus(line);
    EXPECT_EQ(run.exit_code, line[0] == "check" || line[0] == "compile" ? 3 : 1) << line[0];
    EXPECT_THAT(run.out + run.err, HasSubstr("nothing holds the tissue")) << line[0] << line[1];
  }
}

TEST_F(Refusals, ARecordingThatTheDiskDoesNotTakeFailsAndSaysSo) {
  // As a full disk, but without one: a file may not grow beyond 64 KiB.
  const std::string line = std::string("trap '' XFSZ; ulimit -f 64; exec ") + ARTUS_TOOL +
                           " serve --no-images --input injection --seconds 1 --json --record " +
                           in("cut.rec");
  const auto run = test::run_process({"/bin/bash", "-c", line});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, HasSubstr("the recording is not whole"));
}

TEST_F(Refusals, ARecordingOfAHeadAloneIsNoReplay) {
  const auto recorded = artus({"serve", "-j", kSimple, "--rigid", "--no-images", "--input",
                               "injection", "--seconds", "0.2", "--record", in("s.rec"), "--json"});
  ASSERT_EQ(recorded.exit_code, 0) << recorded.err;
  const std::string whole = test::bytes_of(in("s.rec"));
  file("head.rec", whole.substr(0, whole.find('\n') + 1));
  const auto run = artus({"replay", in("head.rec"), "-j", kSimple, "--json"});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_FALSE(nlohmann::json::parse(run.out).at("identical").get<bool>());
  const auto told = artus({"replay", in("head.rec"), "-j", kSimple});
  EXPECT_THAT(told.out, HasSubstr("nothing was there to replay"));
}

constexpr const char* kNeedleHead =
    "time_s,entry_x_mm,entry_y_mm,entry_z_mm,tip_x_mm,tip_y_mm,tip_z_mm\n";

TEST_F(Refusals, ForcesNeedNoProbeAndATimeWithoutEndIsRefusedAtOnce) {
  const std::string poses =
      file("needle.csv",
           std::string(kNeedleHead) + "0,-80,0,-20,-55,0,-14\n" + "0.5,-80,0,-20,-45,0,-12\n");
  const auto run = artus({"force", "-j", kSimple, "--rigid", "--poses", poses, "-o", in("f.csv")});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("501 ticks"));
  for (const char* end : {"1e6", "1e9", "1e300"}) {
    const std::string endless =
        file("endless.csv",
             std::string(kNeedleHead) + "0,-80,0,-20,-55,0,-14\n" + end + ",-80,0,-20,-45,0,-12\n");
    const auto refused =
        artus({"force", "-j", kSimple, "--rigid", "--poses", endless, "-o", in("g.csv")});
    EXPECT_EQ(refused.exit_code, 1);
    EXPECT_THAT(refused.err, HasSubstr("endless.csv: time_s runs over"));
  }
}

constexpr const char* kProbeHead =
    "time_s,probe_x_mm,probe_y_mm,probe_z_mm,direction_x,direction_y,direction_z\n";

TEST_F(Refusals, AVideoOfDaysIsRefusedAndSoIsAProbeInAnotherTown) {
  const std::string days = file("days.csv", std::string(kProbeHead) + "0,-51.8,0,-13.9,1,0,0\n" +
                                                "1e6,-51.8,0,-13.9,1,0,0\n");
  const auto video = artus({"image", "video", "-j", kSimple, "--path", days, "-o", in("v.avi")});
  EXPECT_EQ(video.exit_code, 1);
  EXPECT_THAT(video.err, HasSubstr("days.csv: time_s runs over"));
  const std::string far = file("far.csv", std::string(kProbeHead) + "0,766000,0,0,1,0,0\n");
  const auto sweep = artus({"sweep", "-j", kSimple, "--poses", far, "--out", in("sweep")});
  EXPECT_EQ(sweep.exit_code, 1);
  EXPECT_THAT(sweep.err, HasSubstr("766 m from the joint's origin"));
}

TEST_F(Refusals, ANeedleThatIsTooShortForItsLineIsRefusedInMillimetres) {
  const auto run =
      artus({"inject", "-j", kSimple, "--needle-length-mm", "10", "--no-images", "-o", in("out")});
  EXPECT_NE(run.exit_code, 0);
  EXPECT_THAT(run.err, HasSubstr("a needle of 10.0 mm is too short for this line"));
}

TEST_F(Refusals, AProbeInsideTheBodyOrOffTheSkinIsTold) {
  const auto image = [&](const std::vector<std::string>& more) {
    std::vector<std::string> line{"image", "-j", kSimple, "-o", in("i.png"), "--lines", "32"};
    line.insert(line.end(), more.begin(), more.end());
    return artus(line);
  };
  const auto well = image({"--json"});
  ASSERT_EQ(well.exit_code, 0) << well.err;
  const auto report = nlohmann::json::parse(well.out);
  EXPECT_TRUE(report.at("notes").empty()) << report.at("notes");
  const auto p = report.at("probe").at("position_mm").get<std::vector<double>>();
  const auto z = report.at("probe").at("direction").get<std::vector<double>>();
  const auto x = report.at("probe").at("lateral").get<std::vector<double>>();
  const auto moved = [&](double by) {
    std::string pose = "--probe=";
    for (std::size_t i = 0; i < 3; ++i)
      pose += (i > 0 ? "," : "") + std::to_string(p[i] + by * z[i]);
    for (const auto& v : {z, x})
      for (std::size_t i = 0; i < 3; ++i) pose += (i > 0 ? "," : "/") + std::to_string(v[i]);
    return pose;
  };
  EXPECT_THAT(image({moved(20)}).out, HasSubstr("mm inside the body"));
  EXPECT_THAT(image({moved(-1.5)}).out, HasSubstr("mm or more off the skin"));
}

}  // namespace
}  // namespace artus
