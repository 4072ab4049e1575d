// SPDX-License-Identifier: AGPL-3.0-or-later
#include "viewer/window.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include <unistd.h>

#include <gtest/gtest.h>

#include "tests/sim/session_support.h"

namespace artus {
namespace {

HandTarget above_the_skin() {
  HandTarget target;
  target.X_WN = to_plain(make_pose(Vec3(0, 0, -10e-3), Vec3::UnitZ(), Vec3::UnitX()));
  target.X_WP = to_plain(make_pose(Vec3(0.01, 0, 0), Vec3::UnitZ(), Vec3::UnitX()));
  return target;
}

TEST(Window, AnInjectionWithKeyAndWheelGoesThroughTheLayers) {
  if (std::getenv("DISPLAY") == nullptr) GTEST_SKIP() << "no display; ctest runs it under Xvfb";
  const auto folder = std::filesystem::temp_directory_path();
  const std::string id = std::to_string(getpid());
  const auto recording = folder / ("artus-window-" + id + ".rec");
  const auto picture = folder / ("artus-window-" + id + ".png");
  {
    const SessionParams params = test::make_small_session();
    auto device = std::make_unique<HandDevice>(above_the_skin(), 1 / params.haptic_rate);
    HandDevice* hand = device.get();
    Session::Options options;
    options.haptic_wishes = {};
    options.imaging_wishes = {};
    options.recording = recording;
    auto session = Session::start(test::make_layered_scene(), params, std::move(device), options);
    ASSERT_TRUE(session) << session.error().to_string();
    WindowOptions window;
    window.width = 640;
    window.height = 360;
    window.script = *parse_script(
        "wait 0.3\nkey N\nscroll 40\nwait 1.5\nscroll -1 fine\nkey F1\nkey E\nwait 0.5\nkey "
        "E\nwait 0.3\n",
        "test");
    window.quit_after_script = true;
    window.screenshot = picture;
    const auto shown = run_window(**session, hand, above_the_skin(), window);
    ASSERT_TRUE(shown) << shown.error().to_string();
  }
  const auto read = read_recording(recording);
  ASSERT_TRUE(read) << read.error().to_string();
  const auto deepest = std::max_element(
      read->ticks.begin(), read->ticks.end(), [](const TickRecord& a, const TickRecord& b) {
        return a.input.device.X_WN.position[2] < b.input.device.X_WN.position[2];
      });
  EXPECT_NEAR(deepest->input.device.X_WN.position[2], 10e-3, 0.2e-3);  // 40 notches from -10 mm
  const auto strongest = std::min_element(
      read->ticks.begin(), read->ticks.end(),
      [](const TickRecord& a, const TickRecord& b) { return a.force[2] < b.force[2]; });
  EXPECT_LT(strongest->force[2], -0.5) << "muscle resists";
  EXPECT_TRUE(std::filesystem::exists(picture));
  std::filesystem::remove(recording);
  std::filesystem::remove(picture);
}

}  // namespace
}  // namespace artus
