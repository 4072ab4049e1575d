// SPDX-License-Identifier: AGPL-3.0-or-later
#include <cstdlib>
#include <filesystem>

#include <gtest/gtest.h>

#include "artus/detail/core/units.h"
#include "tests/support/paths.h"
#include "tests/support/temporary_folder.h"
#include "tests/viewer/person.h"

namespace artus {
namespace {

using test::Person;

/// The bundled shoulder, as `artus view -j meshes/shoulder` shows it.
PlannedTask first_task(const CompiledJoint& joint) {
  PlannedTask task;
  task.injection = joint.injections.front();
  const Vec3 axis = (task.injection.target - task.injection.entry).normalized();
  task.start.X_WP = to_plain(joint.X_JP_default);
  task.start.X_WN = to_plain(
      make_pose(task.injection.entry - 10e-3 * axis, axis, joint.X_JP_default.linear().col(1)));
  return task;
}

struct Screen {
  int width;
  int height;
  double font_scale;
};

class WindowInjection : public test::TemporaryFolder,
                        public ::testing::WithParamInterface<Screen> {};

/// Probe, entry, needle, bursa, freeze, caliper, save, clip, and out again.
void inject(Person& person, const std::function<void(const char*)>& photograph) {
  test::XActor& x = person.x();
  EXPECT_NE(person.seen().goal.find("subacromial bursa"), std::string::npos) << person.seen().goal;
  photograph("start");
  x.key("p");
  person.wait_until("the probe is in hand",
                    [](const WindowStatus& s) { return s.grab == Grab::probe; });
  for (int i = 0; i < 4; ++i) x.key("Right");
  for (int i = 0; i < 4; ++i) x.key("Left");
  photograph("probe");
  x.key("c");
  person.wait_until("the entry is chosen",
                    [](const WindowStatus& s) { return s.phase == GesturePhase::inserting; });
  person.wait_pictures(2);  // the button is up again
  x.key("x");               // another: the planned one
  person.wait_until("exploring again",
                    [](const WindowStatus& s) { return s.phase == GesturePhase::exploring; });
  x.key("Escape");
  x.key("Home");
  x.key("n");
  person.wait_until("the needle is in hand",
                    [](const WindowStatus& s) { return s.grab == Grab::needle; });
  x.key("k");
  person.push_until("the tip is in the bursa", [](const WindowStatus& s) { return s.reached; });
  person.wait_until("the clip has pictures",
                    [](const WindowStatus& s) { return s.clip_seconds > 0.2; });
  x.key("k");
  // It is encoded beside the window, which on a busy machine takes longer than the clip plays.
  person.wait_until(
      "a clip",
      [](const WindowStatus& s) { return s.message.find("saved clip") != std::string::npos; }, 600);
  photograph("bursa");
  x.key("f");
  person.wait_until("frozen", [](const WindowStatus& s) { return s.frozen; });
  x.key("Escape");
  person.wait_until("the hands are free",
                    [](const WindowStatus& s) { return s.grab == Grab::nothing; });
  const ImagePlace place = person.seen().image_place;
  x.click(place.x + 12 * place.scale, place.y + 8 * place.scale, 20);
  person.wait_until("a point", [](const WindowStatus& s) { return s.caliper_points == 1; });
  x.click(place.x + 12 * place.scale, place.y + 20 * place.scale, 20);
  person.wait_until("a caliper", [](const WindowStatus& s) { return s.caliper_points == 2; });
  x.key("v");
  person.wait_until("saved", [](const WindowStatus& s) {
    return s.message.find("bmode-1.png") != std::string::npos;
  });
  photograph("frozen");
  x.key("f");
  x.key("n");
  person.wait_until("the needle is in hand again",
                    [](const WindowStatus& s) { return s.grab == Grab::needle; });
  x.wheel(-80);
  person.wait_until("out", [](const WindowStatus& s) { return !s.needle.inside; });
  person.wait_until("done", [](const WindowStatus& s) {
    return s.next.find("starts again") != std::string::npos;
  });
  photograph("end");
}

TEST_P(WindowInjection, APersonBringsTheTipIntoTheBursaByMouseAndKeyboard) {
  if (std::getenv("DISPLAY") == nullptr) GTEST_SKIP() << "no display; ctest runs it under Xvfb";
  const auto x = test::XActor::open();
  ASSERT_NE(x, nullptr);
  const char* other = std::getenv("ARTUS_TEST_JOINT");
  const auto joint = read_compiled_joint(other != nullptr ? std::filesystem::path(other)
                                                          : test::test_joints() / "shoulder.artus");
  ASSERT_TRUE(joint) << joint.error().to_string();
  const auto scene = std::make_shared<const Scene>(std::make_shared<const CompiledJoint>(*joint));
  const char* kept = std::getenv("ARTUS_SCREENSHOTS");
  const std::filesystem::path folder = kept != nullptr ? kept : folder_;
  const Screen screen = GetParam();
  const std::string prefix = std::to_string(screen.width) + "-" +
                             std::to_string(static_cast<int>(screen.font_scale)) + "-";
  WindowOptions options;
  options.width = screen.width;
  options.height = screen.height;
  options.font_scale = screen.font_scale;
  options.welcome = true;
  options.pictures = folder_;
  options.tasks = {first_task(*joint)};
  SessionParams params;
  params.device = *find_device("touch");
  params.gesture.p_W = options.tasks[0].injection.entry;
  params.gesture.axis_W = to_pose(options.tasks[0].start.X_WN).linear().col(2);
  auto device = std::make_unique<HandDevice>(options.tasks[0].start, 1 / params.haptic_rate);
  HandDevice* hand = device.get();
  Session::Options session_options;
  session_options.haptic_options = {};
  auto session = Session::start(scene, params, std::move(device), session_options);
  ASSERT_TRUE(session) << session.error().to_string();
  Person person(*x);
  const auto photograph = [&](const char* what) {
    person.wait_pictures(3);
    x->save_screen(folder / (prefix + what + ".png"), screen.width, screen.height);
  };
  const auto report = person.sit_before(**session, hand, options.tasks[0].start, options,
                                        [&](Person& p) { inject(p, photograph); });
  EXPECT_TRUE(std::filesystem::exists(folder_ / "bmode-1.png"));
  EXPECT_TRUE(std::filesystem::exists(folder_ / "clip-1.avi"));
  RecordProperty("window_ms_p50", std::to_string(1e-3 * report->interval.percentile_us(0.5)));
  if (kept != nullptr)
    std::filesystem::copy_file(folder_ / "bmode-1.png", folder / (prefix + "saved.png"),
                               std::filesystem::copy_options::overwrite_existing);
}

INSTANTIATE_TEST_SUITE_P(Screens, WindowInjection,
                         ::testing::Values(Screen{1280, 720, 1}, Screen{1366, 768, 1},
                                           Screen{1920, 1080, 1}, Screen{1280, 720, 2},
                                           Screen{1366, 768, 2}, Screen{1920, 1080, 2}),
                         [](const auto& test) {
                           return "At" + std::to_string(test.param.width) + "Scale" +
                                  std::to_string(static_cast<int>(test.param.font_scale));
                         });

}  // namespace
}  // namespace artus
