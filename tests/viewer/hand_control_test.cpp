// SPDX-License-Identifier: AGPL-3.0-or-later
#include "viewer/hand_control.h"

#include <cmath>

#include <gtest/gtest.h>

#include "viewer/script.h"

namespace artus {
namespace {

HandTarget start_target() {
  HandTarget target;
  target.X_WN = to_plain(make_pose(Vec3(0, 0, -10e-3), Vec3::UnitZ(), Vec3::UnitX()));
  target.X_WP = to_plain(make_pose(Vec3(0.02, 0, 0), Vec3::UnitZ(), Vec3::UnitX()));
  return target;
}

TEST(HandControl, TheWheelPushesTheGrabbedNeedleAlongItsAxis) {
  HandControl control(start_target());
  EXPECT_FALSE(control.handle(ScrollEvent{4, false}, false));
  EXPECT_TRUE(control.handle(KeyEvent{"N"}, false));
  EXPECT_TRUE(control.handle(ScrollEvent{4, false}, false));
  EXPECT_NEAR(control.target().X_WN.position[2], -8e-3, 1e-12);
  EXPECT_TRUE(control.handle(ScrollEvent{1, true}, false));
  EXPECT_NEAR(control.target().X_WN.position[2], -7.95e-3, 1e-12);
}

TEST(HandControl, AnInsertedNeedleTurnsAboutItsEntry) {
  HandControl control(start_target());
  control.handle(KeyEvent{"N"}, false);
  const Pose before = to_pose(control.target().X_WN);
  control.handle(MoveEvent{100, 100}, true);
  control.handle(MoveEvent{150, 100}, true);
  const Pose after = to_pose(control.target().X_WN);
  const Vec3 pivot = before.translation() - 10e-3 * before.linear().col(2);
  EXPECT_NEAR((after.translation() - pivot).norm(), 10e-3, 1e-9);
  EXPECT_NEAR(std::acos(before.linear().col(2).dot(after.linear().col(2))), 50 * HandControl::kTurn,
              1e-6);
}

TEST(HandControl, TheMouseSlidesTheGrabbedProbeOnTheBody) {
  HandControl control(start_target());
  control.handle(KeyEvent{"P"}, false);
  control.handle(MoveEvent{0, 0}, false);
  control.handle(MoveEvent{10, -20}, false);
  EXPECT_NEAR(control.target().X_WP.position[0], 0.021, 1e-12);
  EXPECT_NEAR(control.target().X_WP.position[1], -2e-3, 1e-12);
  EXPECT_NEAR(control.target().X_WP.position[2], 0, 1e-12);
}

TEST(HandControl, EscapeLetsGoAndHomeGoesBack) {
  HandControl control(start_target());
  control.handle(KeyEvent{"N"}, false);
  control.handle(KeyEvent{"W"}, false);
  control.handle(KeyEvent{"ESCAPE"}, false);
  EXPECT_EQ(control.grab(), Grab::nothing);
  EXPECT_FALSE(control.handle(MoveEvent{5, 5}, false));
  control.handle(KeyEvent{"HOME"}, false);
  EXPECT_NEAR(control.target().X_WN.position[2], -10e-3, 1e-15);
}

TEST(Script, EveryStepIsRead) {
  const auto steps = parse_script(
      "# a comment\nkey N\nwait 0.5\nscroll 3\nscroll -1 fine\nmove 10 20\nbutton 0 down\n"
      "tissue skin 0.1\nscreenshot a.png\ndisconnect\nconnect\ncamera 10 20 150\nmeasure 1 2 3 4\n",
      "test");
  ASSERT_TRUE(steps) << steps.error().to_string();
  EXPECT_EQ(steps->size(), 12U);
  const auto& fine = std::get<ScrollEvent>(std::get<UserEvent>((*steps)[3]));
  EXPECT_TRUE(fine.fine);
  EXPECT_EQ(fine.notches, -1);
}

TEST(Script, AMistakeIsNamedWithItsLine) {
  for (const char* bad : {"wait", "wait -1", "key", "scroll 1 coarse", "dance", "button 0 half"}) {
    const auto steps = parse_script(std::string("key N\n") + bad, "demo");
    ASSERT_FALSE(steps) << bad;
    EXPECT_EQ(steps.error().where, "demo:2");
  }
}

}  // namespace
}  // namespace artus
