// SPDX-License-Identifier: AGPL-3.0-or-later
// The tool against other programs: OpenIGTLink, sequences, registration, trajectories, shards.
#include <csignal>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <sys/wait.h>
#include <unistd.h>

#include <gtest/gtest.h>

#include "artus/anatomy/compiled_joint.h"
#include "artus/detail/core/text_file.h"
#include "artus/detail/exchange/igtl/contents.h"
#include "artus/detail/exchange/igtl/listen_address.h"
#include "artus/detail/exchange/reference_frame.h"
#include "artus/detail/exchange/sequence_file.h"
#include "artus/detail/exchange/tracker_calibration.h"
#include "artus/detail/exchange/tracker_file.h"
#include "tests/apps/run_tool.h"
#include "tests/exchange/igtl_client.h"
#include "tests/support/temporary_folder.h"

namespace artus {
namespace {

namespace fs = std::filesystem;
using test::kSimple;
using test::start_tool;
using testing::HasSubstr;

/// A port that was free a moment ago.
int free_port() {
  const auto socket = igtl::open_listener({"127.0.0.1", 0});
  EXPECT_TRUE(socket);
  const int port = igtl::port_of(*socket);
  close(*socket);
  return port;
}

class ExchangeTool : public test::TemporaryFolder {
 protected:
  [[nodiscard]] std::map<std::string, std::string> content(const std::string& name) const {
    std::map<std::string, std::string> files;
    for (const auto& entry : fs::directory_iterator(folder_ / name))
      if (entry.path().filename().string().rfind("shard-", 0) == 0)
        files[entry.path().filename().string()] = *read_bytes(entry.path());
    return files;
  }
  [[nodiscard]] std::string write(const std::string& name, const std::string& text) const {
    EXPECT_TRUE(write_text(folder_ / name, text));
    return in(name);
  }
};

TEST_F(ExchangeTool, ServeShowsItsPicturesToAnotherProgram) {
  const int port = free_port();
  const pid_t process =
      start_tool({"serve", "-j", kSimple, "--rigid", "--input", "injection", "--prefix",
                  "artus-igtl-" + std::to_string(getpid()) + "-", "--igtl", std::to_string(port)});
  bool listens = false;
  for (int i = 0; i < 600 && !listens; ++i) {
    usleep(100'000);
    const auto taken = igtl::open_listener({"127.0.0.1", port});
    listens = !taken;
    if (taken) close(*taken);
  }
  ASSERT_TRUE(listens);
  {
    test::IgtlClient client(port);
    const auto message = client.wait_for("IMAGE", 60);
    ASSERT_TRUE(message);
    const auto image = igtl::parse_image(message->content);
    ASSERT_TRUE(image);
    EXPECT_EQ(image->width, 400);
    igtl::Message command;
    command.version = 2;
    command.type = "COMMAND";
    command.content = igtl::pack_command({5, "Version", 3, "<Command Name=\"Version\"/>"});
    client.send(command);
    const auto answer = client.wait_for("RTS_COMMAND");
    ASSERT_TRUE(answer);
    EXPECT_EQ(answer->meta_value("Status"), "SUCCESS");
  }
  kill(process, SIGTERM);
  int status = 0;
  waitpid(process, &status, 0);
  EXPECT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 0);
}

TEST_F(ExchangeTool, ServeRefusesWrongAddressesAndCalibrations) {
  const auto wrong = test::artus({"serve", "-j", kSimple, "--input", "injection", "--igtl", "x"});
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_THAT(wrong.err, HasSubstr("[address:]port"));
  const auto alone = test::artus({"serve", "-j", kSimple, "--input", "igtl"});
  EXPECT_EQ(alone.exit_code, 2);
  EXPECT_THAT(alone.err, HasSubstr("--igtl"));
  const auto bad = test::artus({"serve", "-j", kSimple, "--input", "igtl", "--igtl", "0",
                                "--calibration", write("c.toml", "[needle]\n")});
  EXPECT_EQ(bad.exit_code, 1);
  EXPECT_THAT(bad.err, HasSubstr("needle"));
}

TEST_F(ExchangeTool, RegisterFindsWhereATrackerStands) {
  const std::string shoulder = test::test_joints().string() + "/shoulder.artus";
  const auto joint = read_compiled_joint(shoulder);
  ASSERT_TRUE(joint);
  ASSERT_GE(joint->landmarks.size(), 3U);
  const Pose X_JR = make_pose(Vec3(0.3, 0.2, 0.1), Vec3(0.2, 0.3, 1), Vec3::UnitX());
  std::ostringstream pairs;
  pairs.precision(12);
  for (const Landmark& landmark : joint->landmarks) {
    const Vec3 p = 1e3 * (X_JR.inverse() * landmark.position);
    pairs << landmark.name << ',' << p.x() << ',' << p.y() << ',' << p.z() << '\n';
  }
  const auto done = test::artus({"register", "-j", shoulder, "--pairs",
                                 write("pairs.csv", pairs.str()), "-o", in("tracker.toml")});
  ASSERT_EQ(done.exit_code, 0) << done.err;
  EXPECT_THAT(done.out, HasSubstr("rms"));
  const auto calibration = read_tracker_calibration(in("tracker.toml"));
  ASSERT_TRUE(calibration);
  EXPECT_TRUE(calibration->X_JR.isApprox(X_JR, 1e-6));
}

TEST_F(ExchangeTool, APathIsExportedAsASequenceAndReadBackAsPoses) {
  const std::string poses = write("path.jsonl",
                                  "{\"time_s\": 0, \"probe\": {\"position_mm\": [-50, 0, 0], "
                                  "\"direction\": [1, 0, 0], \"lateral\": [0, 0, 1]}}\n"
                                  "{\"time_s\": 1, \"probe\": {\"position_mm\": [-50, 4, 0], "
                                  "\"direction\": [1, 0, 0], \"lateral\": [0, 0, 1]}}\n");
  const std::vector<std::string> small{"--lines", "32", "--planes", "1", "--pixel", "0.5"};
  std::vector<std::string> command{"export", "-j", kSimple, "--poses",         poses,
                                   "--rate", "4",  "--mha", in("path.igs.mha")};
  command.insert(command.end(), small.begin(), small.end());
  const auto done = test::artus(command);
  ASSERT_EQ(done.exit_code, 0) << done.err;
  const auto sequence = read_mha(in("path.igs.mha"));
  ASSERT_TRUE(sequence) << sequence.error().to_string();
  ASSERT_EQ(sequence->frames.size(), 5U);
  const auto back = read_pose_file(in("path.igs.mha"));
  ASSERT_TRUE(back) << back.error().to_string();
  EXPECT_TRUE(back->poses.at(2).X_JP.translation().isApprox(Vec3(-0.05, 0.002, 0), 1e-6));
  command = {"sweep", "-j", kSimple, "--poses", in("path.igs.mha"), "-o", in("again")};
  command.insert(command.end(), small.begin(), small.end());
  const auto swept = test::artus(command);
  ASSERT_EQ(swept.exit_code, 0) << swept.err;
  EXPECT_TRUE(fs::exists(folder_ / "again/frames/000004.png"));
}

TEST_F(ExchangeTool, ARecordingIsExportedWithAPageAboutIt) {
  const auto served =
      test::artus({"serve", "-j", kSimple, "--rigid", "--input", "injection", "--seconds", "2",
                   "--speed-mm-s", "40", "--image-rate", "10", "--prefix",
                   "artus-export-" + std::to_string(getpid()) + "-", "--record", in("s.rec")});
  ASSERT_EQ(served.exit_code, 0) << served.err;
  const auto done = test::artus({"export", "-j", kSimple, "--recording", in("s.rec"), "--mha",
                                 in("s.igs.mha"), "--report", in("page.png")});
  ASSERT_EQ(done.exit_code, 0) << done.err;
  const auto sequence = read_mha(in("s.igs.mha"));
  ASSERT_TRUE(sequence) << sequence.error().to_string();
  EXPECT_GT(sequence->frames.size(), 5U);
  EXPECT_TRUE(sequence->frames.back().needle_to_reference.has_value());
  for (std::size_t i = 1; i < sequence->frames.size(); ++i)
    EXPECT_GT(sequence->frames[i].time, sequence->frames[i - 1].time);
  EXPECT_GT(fs::file_size(in("page.png")), 20000U);
  // What was written leads a session of its own, which is the same again.
  const auto led = test::artus({"replay", in("s.igs.mha"), "-j", kSimple, "--trace", in("t.csv")});
  EXPECT_EQ(led.exit_code, 0) << led.err;
  EXPECT_THAT(led.out, HasSubstr(" 0 different;"));
  const auto neither = test::artus({"export", "-j", kSimple, "--mha", in("x.mha")});
  EXPECT_EQ(neither.exit_code, 2);
  EXPECT_THAT(neither.err, HasSubstr("a recording, a list of poses or a sweep"));
}

TEST_F(ExchangeTool, ASweepIsExportedAsASequence) {
  const std::vector<std::string> small{"--lines", "32", "--planes", "1", "--pixel", "0.5"};
  const auto sweep = [&](std::vector<std::string> more) {
    std::vector<std::string> command{"sweep", "-j", kSimple};
    command.insert(command.end(), more.begin(), more.end());
    command.insert(command.end(), small.begin(), small.end());
    const auto done = test::artus(command);
    EXPECT_EQ(done.exit_code, 0) << done.err;
  };
  sweep({"--draw", "5", "--frames-per-shard", "2", "-o", in("shards")});
  for (const char* name : {"shards", "folder"}) {
    if (name == std::string("folder")) sweep({"--poses", in("shards.igs.mha"), "-o", in("folder")});
    const auto done = test::artus({"export", "-j", kSimple, "--sweep", in(name), "--mha",
                                   in(name + std::string(".igs.mha"))});
    ASSERT_EQ(done.exit_code, 0) << done.err;
  }
  // Through the sequence's matrices and back: the same places, and so the same pictures but for
  // what is lost in a text of millimetres.
  const auto first = read_mha(in("shards.igs.mha"));
  const auto second = read_mha(in("folder.igs.mha"));
  ASSERT_TRUE(first && second);
  ASSERT_EQ(first->frames.size(), 5U);
  ASSERT_EQ(second->frames.size(), 5U);
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_TRUE(
        first->frames[i].image_to_reference.isApprox(second->frames[i].image_to_reference, 1e-6));
    EXPECT_EQ(first->frames[i].grey.size(), second->frames[i].grey.size());
  }
}

TEST_F(ExchangeTool, PressedNeedlesAndProbesAreDrawnTheSameInAnyOrder) {
  const std::string ranges =
      write("ranges.toml",
            "[needle]\ngauge = [18, 25]\nlength_mm = [35, 60]\n[press]\nshare = 0.5\n"
            "depth_mm = [0.5, 2]\n[transducer]\nnames = [\"linear-6-18\", \"linear-4-9\"]\n");
  const auto draw = [&](const std::string& name, const std::string& range) {
    const auto done = test::artus(
        {"sweep", "-j",       kSimple, "--draw",   "4",     "--seed",  "2",   "--ranges",
         ranges,  "--lines",  "32",    "--planes", "1",     "--pixel", "0.5", "--frames-per-shard",
         "2",     "--frames", range,   "-o",       in(name)});
    ASSERT_EQ(done.exit_code, 0) << done.err;
  };
  draw("whole", "0:4");
  draw("parts", "2:4");
  draw("parts", "0:2");
  EXPECT_EQ(content("parts"), content("whole"));
  std::string all;
  for (const auto& [name, bytes] : content("whole")) all += bytes;
  EXPECT_NE(all.find("\"press\":{\"depth_mm\":"), std::string::npos);
  EXPECT_NE(all.find("\"settled\":true"), std::string::npos);
  const auto missing =
      test::artus({"sweep", "-j", kSimple, "--draw", "2", "--ranges",
                   write("bad.toml", "[transducer]\nnames = [\"sonar\"]\n"), "-o", in("bad")});
  EXPECT_EQ(missing.exit_code, 2);
  EXPECT_THAT(missing.err, HasSubstr("sonar"));
  const auto curved = test::artus(
      {"sweep", "-j", kSimple, "--draw", "2", "--ranges",
       write("curved.toml", "[transducer]\nnames = [\"curved-2-5\"]\n[press]\nshare = 0.5\n"), "-o",
       in("curved")});
  EXPECT_EQ(curved.exit_code, 2);
  EXPECT_THAT(curved.err, HasSubstr("curved-2-5: only a straight probe"));
}

TEST_F(ExchangeTool, ForcesOfATrajectoryAreATable) {
  const auto joint = read_compiled_joint(kSimple);
  ASSERT_TRUE(joint);
  ASSERT_FALSE(joint->injections.empty());
  const PlannedInjection& plan = joint->injections.front();
  const Vec3 axis = (plan.target - plan.entry).normalized();
  std::ostringstream path;
  for (int i = 0; i < 2; ++i) {
    const Vec3 tip = 1e3 * (i == 0 ? Vec3(plan.entry - 5e-3 * axis) : plan.target);
    const Vec3 hub = tip - 35 * axis;
    path << "{\"time_s\": " << 2 * i << ", \"probe\": {\"position_mm\": [0,0,0], \"direction\": "
         << "[0,0,1]}, \"needle\": {\"entry_mm\": [" << hub.x() << ',' << hub.y() << ',' << hub.z()
         << "], \"tip_mm\": [" << tip.x() << ',' << tip.y() << ',' << tip.z() << "]}}\n";
  }
  const auto done = test::artus({"force", "-j", kSimple, "--poses", write("p.jsonl", path.str()),
                                 "-o", in("force.csv"), "--rigid", "--json"});
  ASSERT_EQ(done.exit_code, 0) << done.err;
  EXPECT_THAT(done.out, HasSubstr("\"ticks\": 2001"));
  const std::string table = *read_bytes(in("force.csv"));
  EXPECT_EQ(table.rfind("time_s,depth_mm,region,", 0), 0U);
  EXPECT_NE(table.find(",muscle,"), std::string::npos);
  EXPECT_NE(table.find(",bursa,"), std::string::npos);
}

TEST_F(ExchangeTool, AJobThatIsKilledAndStartedAgainGivesTheBytesOfTheUndividedSweep) {
  const auto job = [this](const std::string& folder, const std::string& shard) {
    return std::vector<std::string>{
        "sweep", "-j",      kSimple,   "--draw",   "60", "--seed",    "7", "--frames-per-shard",
        "6",     "--lines", "64",      "--planes", "1",  "--threads", "1", "--shard",
        shard,   "-o",      in(folder)};
  };
  const auto whole = test::artus(job("whole", "0/1"));
  ASSERT_EQ(whole.exit_code, 0) << whole.err;
  for (const char* shard : {"0/2", "1/2"}) {
    const pid_t process = start_tool(job("jobs", shard));
    const auto finished = [&] {
      return fs::exists(folder_ / "jobs") ? content("jobs").size() : 0;
    };
    const std::size_t before = finished();
    for (int i = 0; i < 6000 && finished() < before + 2; ++i) usleep(10'000);
    kill(process, SIGKILL);
    waitpid(process, nullptr, 0);
    EXPECT_LT(content("jobs").size(), before + 10);  // it was in the middle
    const auto again = test::artus(job("jobs", shard));
    EXPECT_EQ(again.exit_code, 0) << again.err;
  }
  EXPECT_EQ(content("jobs"), content("whole"));
  const auto merged = test::artus({"sweep", "merge", in("jobs")});
  EXPECT_EQ(merged.exit_code, 0) << merged.err;
  EXPECT_THAT(merged.out, HasSubstr("60 frames in 10 shards"));
  fs::remove(folder_ / "jobs/shard-000004.json");
  const auto missing = test::artus({"sweep", "merge", in("jobs")});
  EXPECT_EQ(missing.exit_code, 1);
  EXPECT_THAT(missing.err, HasSubstr("missing: frames 24:30"));
}

}  // namespace
}  // namespace artus
