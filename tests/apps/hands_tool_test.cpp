// SPDX-License-Identifier: AGPL-3.0-or-later
// `artus hands` as a program, the first page of `artus train --hands`, and what one calibration
// file says of any hand.
#include <fstream>

#include <gmock/gmock.h>

#include <gtest/gtest.h>

#include "artus/detail/core/text_file.h"
#include "artus/detail/exchange/reference_frame.h"
#include "artus/detail/exchange/tracker_calibration.h"
#include "artus/detail/trainer/hands_pages.h"
#include "artus/detail/training/scenario.h"
#include "tests/apps/run_tool.h"
#include "tests/support/temporary_folder.h"

namespace artus {
namespace {

using testing::HasSubstr;

class HandsTool : public test::TemporaryFolder {};

TEST_F(HandsTool, PrintsAKitAndSaysWhatOfItWasMeasured) {
  const auto printed = test::artus({"hands", "print", "-o", in("kit"), "--hand", "left"});
  ASSERT_EQ(printed.exit_code, 0) << printed.err;
  for (const char* name : {"probe.stl", "syringe.stl", "plunger.stl", "divots.stl", "markers.pdf",
                           "sheet.pdf", "board.pdf"})
    EXPECT_TRUE(std::filesystem::exists(folder_ / "kit" / name)) << name;
  const auto state = test::artus({"hands", "state", "-k", in("hands.toml")});
  ASSERT_EQ(state.exit_code, 0) << state.err;
  const auto parsed = parse_hands_state(state.out);
  ASSERT_TRUE(parsed) << parsed.error().to_string();
  EXPECT_FALSE(parsed->camera || parsed->markers || parsed->tip || parsed->face);
  EXPECT_GT(parsed->error_mm, 1);
  EXPECT_FALSE(parse_hands_state(""));
}

TEST_F(HandsTool, SaysWhatIsMissing) {
  EXPECT_EQ(test::artus({"hands"}).exit_code, 2);
  EXPECT_THAT(test::artus({"hands", "--help"}).out, HasSubstr("artus hands print -o kit"));
  const auto run = test::artus({"hands", "run", "webcam", "-k", in("hands.toml")});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, HasSubstr("calibrate the camera first"));
  const auto no_file = test::artus({"hands", "calibrate", in("no.mp4"), "-k", in("hands.toml")});
  EXPECT_EQ(no_file.exit_code, 1);
  EXPECT_THAT(no_file.err, HasSubstr("no such file"));
  std::ofstream(in("bad.toml")) << "[print]\nruler_mm = 3\n";
  EXPECT_EQ(test::artus({"hands", "state", "-k", in("bad.toml")}).exit_code, 1);
}

TEST_F(HandsTool, OneCalibrationFileHasScaleInsertionPointAndTheBlock) {
  const std::string file = in("hand.toml");
  ASSERT_EQ(test::artus({"register", "--insertion", "10,0,-20,0,0,-2", "-o", file}).exit_code, 0);
  ASSERT_EQ(test::artus({"register", "--scenario", "gel-find", "--scale", "0.97", "--calibration",
                         file, "-o", file})
                .exit_code,
            0);
  const auto read = read_tracker_calibration(file);
  ASSERT_TRUE(read) << read.error().to_string();
  EXPECT_DOUBLE_EQ(read->scale, 0.97);
  ASSERT_TRUE(read->insertion);
  EXPECT_NEAR(read->insertion->p_W.x(), 0.01, 1e-12);
  EXPECT_NEAR(read->insertion->axis_W.z(), -1, 1e-12);
  const auto scenario = find_scenario("gel-find");
  EXPECT_TRUE(read->X_JR.isApprox(block_in_joint(scenario->X_JP), 1e-9));
  // 30 mm over the block is 30 mm before the probe's face.
  const Vec3 above = scenario->X_JP.inverse() * (read->X_JR * Vec3(0, 0, 0.03));
  EXPECT_NEAR(above.z(), -0.03, 1e-12);
  EXPECT_EQ(test::artus({"register", "-o", file}).exit_code, 2);
  EXPECT_EQ(test::artus({"register", "--insertion", "1,2,3", "-o", file}).exit_code, 2);
}

TEST(HandsPage, LeadsToWhatIsToDoAndSaysThatThereIsNoForce) {
  const HandsSetup setup{"artus-hands", "webcam", "hands.toml", "prints"};
  HandsState state;
  Page page = make_hands_page(state, setup, Language::english);
  EXPECT_EQ(page.name, "hands");
  EXPECT_EQ(page.at, static_cast<std::size_t>(HandsChoice::print));
  EXPECT_EQ(page.choices.size(), static_cast<std::size_t>(HandsChoice::leave) + 1);
  EXPECT_THAT(page.lines[1].text, HasSubstr("no force"));
  EXPECT_THAT(page.lines[2].text, HasSubstr("not calibrated"));
  state.camera = true;
  EXPECT_EQ(make_hands_page(state, setup, Language::english).at,
            static_cast<std::size_t>(HandsChoice::tip));
  state.tip = state.face = true;
  state.error_mm = 0.84;
  page = make_hands_page(state, setup, Language::french);
  EXPECT_EQ(page.at, static_cast<std::size_t>(HandsChoice::go));
  EXPECT_THAT(page.lines[2].text, HasSubstr("0.8"));
  EXPECT_EQ(hands_arguments(HandsChoice::tip, setup),
            (std::vector<std::string>{"pivot", "webcam", "-k", "hands.toml"}));
}

TEST_F(HandsTool, TheFirstPageIsShownAndCanBeLeft) {
  if (!test::has_virtual_display()) GTEST_SKIP() << "xvfb-run is not installed";
  std::ofstream(in("steps")) << "page hands\nkey DOWN\nkey DOWN\nkey DOWN\nkey DOWN\nkey DOWN\n"
                                "key ENTER\n";
  const auto left = test::run_process({"xvfb-run", "-a", "timeout", "60", ARTUS_TOOL, "train",
                                       "--hands", in("pictures"), "--records", in("records.db"),
                                       "--script", in("steps"), "--language", "en"});
  EXPECT_EQ(left.exit_code, 0) << left.out << left.err;
}

TEST(HandsProgramTest, TellsLinesAndHowItEndedAndEndsWithItsObject) {
  {
    const HandsProgram echo("/bin/sh", {"-c", "echo one; echo two; exit 3"});
    for (int i = 0; i < 2000 && !echo.ended(); ++i) usleep(1000);
    EXPECT_EQ(echo.lines(), (std::vector<std::string>{"one", "two"}));
    EXPECT_EQ(echo.exit_code(), 3);
  }
  const auto begin = std::chrono::steady_clock::now();
  { const HandsProgram waits("/bin/sleep", {"30"}); }
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(5));
  const HandsProgram none("/no/such/program", {});
  for (int i = 0; i < 2000 && !none.ended(); ++i) usleep(1000);
  EXPECT_EQ(none.exit_code(), 127);
}

}  // namespace
}  // namespace artus
