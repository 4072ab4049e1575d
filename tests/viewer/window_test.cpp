// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/viewer/window.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/videoio.hpp>

#include <gtest/gtest.h>

#include "artus/detail/core/units.h"
#include "artus/session/replay.h"
#include "tests/session/session_support.h"
#include "tests/support/temporary_folder.h"

namespace artus {
namespace {

HandTarget above_the_skin() {
  HandTarget target;
  target.X_WN = to_plain(make_pose(Vec3(0, 0, -10e-3), Vec3::UnitZ(), Vec3::UnitX()));
  target.X_WP = to_plain(make_pose(Vec3(0.01, 0, 0), Vec3::UnitZ(), Vec3::UnitX()));
  return target;
}

/// A window that a script drives, over a recorded session with the hand of mouse and keyboard.
class Window : public test::TemporaryFolder {
 protected:
  void SetUp() override {
    TemporaryFolder::SetUp();
    if (std::getenv("DISPLAY") == nullptr) GTEST_SKIP() << "no display; ctest runs it under Xvfb";
    options_.width = 960;
    options_.height = 540;
    options_.quit_after_script = true;
    options_.pictures = folder_;
  }

  /// Runs the script and fills report_ and recording_.
  void run(const std::string& script) {
    auto device = std::make_unique<HandDevice>(above_the_skin(), 1 / params_.haptic_rate);
    HandDevice* hand = device.get();
    Session::Options options;
    options.haptic_options = {};
    options.imaging_options = {};
    options.recording = folder_ / "session.rec";
    {
      auto session = Session::start(scene_, params_, std::move(device), options);
      ASSERT_TRUE(session) << session.error().to_string();
      const auto steps = parse_script(script, "test");
      ASSERT_TRUE(steps) << steps.error().to_string();
      options_.script = *steps;
      report_ = std::make_unique<WindowReport>();
      const auto shown = run_window(**session, hand, above_the_skin(), options_, *report_);
      ASSERT_TRUE(shown) << shown.error().to_string();
    }
    auto read = read_recording(options.recording);
    ASSERT_TRUE(read) << read.error().to_string();
    recording_ = std::move(*read);
  }

  /// What the recorded session felt, tick by tick.
  [[nodiscard]] std::vector<HapticSnapshot> felt() const {
    std::vector<HapticSnapshot> ticks;
    ReplayListener listener;
    listener.on_tick = [&ticks](const HapticSnapshot& tick) {
      ticks.push_back(tick);
    };
    Recording haptics = recording_;
    haptics.frames.clear();
    const auto report = replay(haptics, scene_, listener);
    EXPECT_TRUE(report && report->identical());
    return ticks;
  }

  [[nodiscard]] const std::string& layer(const HapticSnapshot& tick) const {
    return scene_->joint().regions[tick.feedback.region].name;
  }

  std::shared_ptr<const Scene> scene_ = test::make_layered_scene();
  SessionParams params_ = test::make_small_session();
  WindowOptions options_;
  std::unique_ptr<WindowReport> report_;
  Recording recording_;
};

TEST_F(Window, AnInjectionWithKeyAndWheelGoesThroughTheLayers) {
  options_.screenshot = folder_ / "end.png";
  run("wait 0.3\nkey N\nscroll 40\nwait 1.5\nscroll -1 fine\nkey F1\nkey E\nwait 0.5\nkey E\n"
      "wait 0.3\n");
  const auto ticks = felt();
  const auto deepest = std::max_element(
      ticks.begin(), ticks.end(),
      [](const auto& a, const auto& b) { return a.feedback.depth < b.feedback.depth; });
  EXPECT_NEAR(deepest->feedback.depth, 10e-3, 0.2e-3);  // 40 notches from -10 mm
  EXPECT_EQ(layer(*deepest), "muscle");
  const auto strongest = std::min_element(
      ticks.begin(), ticks.end(),
      [](const auto& a, const auto& b) { return a.feedback.force[2] < b.feedback.force[2]; });
  EXPECT_LT(strongest->feedback.force[2], -0.5) << "muscle resists";
  EXPECT_TRUE(std::filesystem::exists(options_.screenshot));
  EXPECT_GT(report_->joint.count(), 0U) << "whole pictures of the joint";
}

TEST_F(Window, AGamepadsTriggerInjects) {
  run("wait 0.3\npad 0 0 0 0 1 1.2\nwait 1.0\npad 0 0 0 0 -1 1.2\nwait 1.0\n");
  const auto ticks = felt();
  double deepest = 0;
  for (const HapticSnapshot& tick : ticks) deepest = std::max(deepest, tick.feedback.depth);
  EXPECT_NEAR(deepest, 1.2 * HandControl::kPadPush - 10e-3, 0.3e-3);
  EXPECT_EQ(ticks.back().inserted, 0U) << "and takes the needle out again";
}

TEST_F(Window, TheGestureOfTwoPhasesInjectsWhereTheProbeChoseTheEntry) {
  // The mouse slides the probe 5 mm along x; the entry lies 30 mm beside it.
  run("wait 0.3\nkey P\nmove 100 100\nmove 150 100\nwait 0.5\nkey C\nwait 0.5\nkey N\n"
      "scroll 60\nwait 1.5\n");
  const auto ticks = felt();
  const HapticSnapshot& last = ticks.back();
  EXPECT_EQ(last.phase, GesturePhase::inserting);
  EXPECT_EQ(last.inserted, 1U);
  const Vec3 entry(last.entry_J[0], last.entry_J[1], last.entry_J[2]);
  EXPECT_LT((entry - Vec3(0.015 - params_.gesture.beside_probe, 0, 0)).norm(), 0.3e-3);
  const Vec3 axis = to_pose(last.X_JN).linear().col(2);
  EXPECT_NEAR(axis.z(), std::sin(params_.gesture.steepness), 1e-3);
  EXPECT_NEAR(last.feedback.depth, 20e-3, 0.3e-3);
  EXPECT_LT((to_pose(last.X_JP).translation() - Vec3(0.015, 0, 0)).norm(), 0.1e-3)
      << "the probe stayed on the body";
  std::vector<std::string> layers;
  for (const HapticSnapshot& tick : ticks) {
    if ((tick.status & TickStatus::kLate) != 0) continue;  // a busy machine: the force rests
    if (layers.empty() || layers.back() != layer(tick)) layers.push_back(layer(tick));
  }
  EXPECT_EQ(layers, (std::vector<std::string>{"outside", "skin", "fat", "muscle"}));
  double strongest = 0;
  for (const HapticSnapshot& tick : ticks)
    strongest = std::max(strongest, -tick.feedback.force[2]);  // the device's axis is W's z
  EXPECT_GT(strongest, 0.5);
}

TEST_F(Window, ALostDeviceIsZeroForceAndComesBack) {
  run("wait 0.3\nkey N\nscroll 50\nwait 1.2\ndisconnect\nwait 0.4\nconnect\nwait 0.8\n");
  const auto ticks = felt();
  std::int64_t first_lost = 0;
  std::int64_t last_lost = 0;
  for (const HapticSnapshot& tick : ticks) {
    if ((tick.status & SessionStatus::kPeerLost) == 0) continue;
    last_lost = tick.input.device.time_ns;
    if (first_lost == 0) first_lost = last_lost;
    for (const double f : tick.feedback.force) ASSERT_EQ(f, 0);
  }
  EXPECT_GT(last_lost - first_lost, 300'000'000);
  EXPECT_EQ(ticks.back().status & SessionStatus::kPeerLost, 0U);
}

TEST_F(Window, AtTrueScaleTheBoneStandsAtItsDepthOnTheScreenAndCalipersMeasureIt) {
  options_.pixels_per_mm = 6;
  options_.screenshot = folder_ / "scale.png";
  run("wait 0.3\nkey T\nwait 1.0\n");
  const ImagePlace place = report_->image_place;
  ASSERT_NEAR(place.scale, 6, 1e-6);
  // The scanner takes the layers' echoes to have come at its own speed of sound.
  double shown_mm = 0;
  const Segment line{Vec3(0.01, 0, -1e-3), Vec3(0.01, 0, 60e-3)};
  for (const TissueInterval& s : tissue_intervals(*scene_, line)) {
    const Tissue& tissue = scene_->joint().tissue_of(s.region);
    if (tissue.haptic.hard) break;
    if (s.region != kOutside)
      shown_mm += (s.exit - s.entry) * kDisplaySpeedOfSound / tissue.acoustic.speed_of_sound * 1e3;
  }
  const cv::Mat screen = cv::imread(options_.screenshot.string(), cv::IMREAD_GRAYSCALE);
  ASSERT_FALSE(screen.empty());
  const int column = static_cast<int>(place.x + 6 * 20);  // the image's middle: the probe is 40 mm
  int brightest = 0;
  double most = 0;
  for (int y = static_cast<int>(place.y + 6 * 20); y < static_cast<int>(place.y + 6 * 38); ++y) {
    double sum = 0;
    for (int x = column - 20; x < column + 20; ++x) sum += screen.at<std::uint8_t>(y, x);
    if (sum <= most) continue;
    most = sum;
    brightest = y;
  }
  const double seen_mm = place.point_at(0, brightest + 0.5).y_mm;
  EXPECT_NEAR(seen_mm, shown_mm, 0.5) << "bone in the screenshot";

  // A person clicks on the skin line and on the bone.
  std::ostringstream script;
  script << "wait 0.3\nkey T\nwait 0.5\n";
  for (const double y : {place.y, brightest + 0.5})
    script << "move " << column << ' ' << y
           << "\nwait 0.1\nbutton 0 down\nwait 0.1\nbutton 0 up\nwait 0.1\n";
  run(script.str());
  ASSERT_EQ(report_->calipers.size(), 2U);
  const double measured = std::hypot(report_->calipers[1].x_mm - report_->calipers[0].x_mm,
                                     report_->calipers[1].y_mm - report_->calipers[0].y_mm);
  EXPECT_NEAR(measured, shown_mm, 0.5);
}

TEST_F(Window, AClipPlaysAsFastAsItWasRecorded) {
  run("wait 0.5\nkey K\nwait 1.2\nkey K\nwait 0.3\nkey V\nwait 0.2\n");
  cv::VideoCapture clip((folder_ / "clip-1.avi").string());
  ASSERT_TRUE(clip.isOpened());
  int frames = 0;
  cv::Mat picture;
  while (clip.read(picture)) ++frames;
  // A step of a script ends with a picture, and a busy machine draws few: what the session lasted
  // longer than its script may be in the clip.
  const double lasted = 1e-9 * static_cast<double>(recording_.ticks.back().input.device.time_ns -
                                                   recording_.ticks.front().input.device.time_ns);
  const double plays = frames / clip.get(cv::CAP_PROP_FPS);
  EXPECT_GT(plays, 1.1);
  EXPECT_LT(plays, 1.3 + std::max(0.0, lasted - 2.2));
  const cv::Mat saved = cv::imread((folder_ / "bmode-1.png").string(), cv::IMREAD_GRAYSCALE);
  ASSERT_FALSE(saved.empty());
}

TEST_F(Window, ThePanelsStayWhereTheyWerePut) {
  options_.width = 1280;
  options_.height = 720;
  options_.layout = folder_ / "layout.txt";
  run("wait 2\n");
  const ImagePlace before = report_->image_place;
  ASSERT_GT(before.y, 0) << "no image was shown";
  ASSERT_TRUE(std::filesystem::exists(options_.layout)) << "the layout was not saved";
  std::ofstream(options_.layout) << "picture 0.37 0.3 0.4 0.5\n";
  run("wait 2\n");
  EXPECT_GT(report_->image_place.y - before.y, 50);
  std::ifstream in(options_.layout);
  const std::string text((std::istreambuf_iterator<char>(in)), {});
  EXPECT_EQ(text.substr(0, 12), "picture 0.37") << "and are kept";
}

TEST_F(Window, EveryKnobOfTheScannerReachesTheRenderer) {
  // Six sliders under one another, below the task's two lines; a click near their left end turns
  // each down.
  options_.width = 1280;
  options_.height = 720;
  std::ostringstream script;
  script << "wait 0.4\n";
  for (int row = 0; row < 6; ++row)
    script << "move 1005 " << 50 + 36 + 23 * row << "\nbutton 0 down\nbutton 0 up\nwait 0.1\n";
  script << "wait 0.5\n";
  run(script.str());
  ASSERT_FALSE(recording_.frames.empty());
  const ImageControls before = controls_of(params_);
  const ImageControls& after = recording_.frames.back().input.controls;
  EXPECT_LT(after.depth, before.depth);
  EXPECT_LT(after.gain_db, before.gain_db);
  EXPECT_LT(after.tgc_db_cm_mhz, before.tgc_db_cm_mhz);
  EXPECT_LT(after.dynamic_range_db, before.dynamic_range_db);
  EXPECT_LT(after.frequency, before.frequency);
  EXPECT_LT(after.elevation_focus, before.elevation_focus);
  const auto report = replay(recording_, scene_);
  EXPECT_TRUE(report && report->identical()) << "and a replay turns them, too";
}

}  // namespace
}  // namespace artus
