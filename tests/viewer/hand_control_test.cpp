// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/viewer/hand_control.h"

#include <cmath>

#include <gtest/gtest.h>

#include "artus/viewer/gamepad.h"
#include "artus/viewer/script.h"

namespace artus {
namespace {

constexpr std::nullopt_t kNotInside = std::nullopt;

HandTarget start_target() {
  HandTarget target;
  target.X_WN = to_plain(make_pose(Vec3(0, 0, -10e-3), Vec3::UnitZ(), Vec3::UnitX()));
  target.X_WP = to_plain(make_pose(Vec3(0.02, 0, 0), Vec3::UnitZ(), Vec3::UnitX()));
  return target;
}

TEST(HandControl, TheWheelPushesTheGrabbedNeedleAlongItsAxis) {
  HandControl control(start_target());
  EXPECT_FALSE(control.handle(ScrollEvent{4, false}, kNotInside));
  EXPECT_TRUE(control.handle(KeyEvent{"N"}, kNotInside));
  EXPECT_TRUE(control.handle(ScrollEvent{4, false}, kNotInside));
  EXPECT_NEAR(control.target().X_WN.position[2], -8e-3, 1e-12);
  EXPECT_TRUE(control.handle(ScrollEvent{1, true}, kNotInside));
  EXPECT_NEAR(control.target().X_WN.position[2], -7.95e-3, 1e-12);
}

TEST(HandControl, AnInsertedNeedleTurnsAboutItsEntry) {
  HandControl control(start_target());
  control.handle(KeyEvent{"N"}, kNotInside);
  control.handle(ScrollEvent{50, false}, kNotInside);  // tip 15 mm beyond the skin at z = 0
  const Pose before = to_pose(control.target().X_WN);
  control.handle(MoveEvent{100, 100}, Vec3(0, 0, 0));
  control.handle(MoveEvent{150, 100}, Vec3(0, 0, 0));
  const Pose after = to_pose(control.target().X_WN);
  EXPECT_NEAR(after.translation().norm(), 15e-3, 1e-9);
  EXPECT_NEAR(after.translation().normalized().dot(after.linear().col(2)), 1, 1e-9)
      << "the shaft goes through the entry";
  EXPECT_NEAR(std::acos(before.linear().col(2).dot(after.linear().col(2))), 50 * HandControl::kTurn,
              1e-6);
}

TEST(HandControl, ShiftMovesWhatIsInHandATenthAsFar) {
  HandControl control(start_target());
  control.handle(KeyEvent{"P"}, kNotInside);
  control.handle(MoveEvent{0, 0}, kNotInside);
  control.handle(MoveEvent{10, 0, true}, kNotInside);
  EXPECT_NEAR(control.target().X_WP.position[0], 0.0201, 1e-12);
}

TEST(HandControl, TheMouseSlidesTheGrabbedProbeOnTheBody) {
  HandControl control(start_target());
  control.handle(KeyEvent{"P"}, kNotInside);
  control.handle(MoveEvent{0, 0}, kNotInside);
  control.handle(MoveEvent{10, -20}, kNotInside);
  EXPECT_NEAR(control.target().X_WP.position[0], 0.021, 1e-12);
  EXPECT_NEAR(control.target().X_WP.position[1], -2e-3, 1e-12);
  EXPECT_NEAR(control.target().X_WP.position[2], 0, 1e-12);
}

TEST(HandControl, EscapeLetsGoAndHomeGoesBack) {
  HandControl control(start_target());
  control.handle(KeyEvent{"N"}, kNotInside);
  control.handle(KeyEvent{"W"}, kNotInside);
  control.handle(KeyEvent{"ESCAPE"}, kNotInside);
  EXPECT_EQ(control.grab(), Grab::nothing);
  EXPECT_FALSE(control.handle(MoveEvent{5, 5}, kNotInside));
  control.handle(KeyEvent{"HOME"}, kNotInside);
  EXPECT_NEAR(control.target().X_WN.position[2], -10e-3, 1e-15);
}

TEST(HandControl, AButtonIsAShortPress) {
  HandControl control(start_target());
  control.handle(KeyEvent{"C"}, kNotInside);
  EXPECT_EQ(control.target().buttons, Button::kCalibrate);
  control.release();
  EXPECT_EQ(control.target().buttons, 0U);
}

TEST(HandControl, TheProbeStaysOnTheBodyWhenTheJointIsMoved) {
  HandControl control(start_target());
  control.handle(KeyEvent{"N"}, kNotInside);
  control.handle(ScrollEvent{3, false}, kNotInside);
  const Pose X_WP = to_pose(control.target().X_WP);
  Pose moved = Pose::Identity();
  moved.linear() = Eigen::AngleAxisd(0.4, Vec3::UnitY()).toRotationMatrix();
  moved.translation() = Vec3(0.01, -0.02, 0.03);
  const std::uint32_t jumps = control.target().probe_jumps;
  control.follow_joint(Pose::Identity(), moved);
  const Pose X_JP = moved.inverse() * to_pose(control.target().X_WP);
  EXPECT_TRUE(X_JP.isApprox(X_WP, 1e-12));
  EXPECT_NE(control.target().probe_jumps, jumps);
  EXPECT_NEAR(control.target().X_WN.position[2], -10e-3, 1e-15) << "at the insertion point";
}

TEST(HandControl, AGamepadMovesProbeAndNeedleAtOnce) {
  HandControl control(start_target());
  EXPECT_TRUE(control.handle(PadEvent{1, 0, 0, 0, 0.5, 0.1}, kNotInside));
  EXPECT_NEAR(control.target().X_WP.position[0], 0.02 + 0.1 * HandControl::kPadSlide, 1e-12);
  EXPECT_NEAR(control.target().X_WN.position[2], -10e-3 + 0.05 * HandControl::kPadPush, 1e-12);
  control.handle(PadEvent{0, 0, 1, 0, 0, 0.5}, Vec3(0, 0, -20e-3));
  EXPECT_NEAR(std::acos(to_pose(control.target().X_WN).linear()(2, 2)), 0.5 * HandControl::kPadTurn,
              1e-9);
}

TEST(Gamepad, RestingSticksDoNothingAndAButtonActsOnce) {
  PadState rest;
  rest.left = {0.1, -0.12};
  EXPECT_TRUE(events_of(rest, PadState{}, 0.03).empty());
  PadState pressed = rest;
  pressed.buttons[PadState::a] = true;
  const auto events = events_of(pressed, rest, 0.03);
  ASSERT_EQ(events.size(), 1U);
  EXPECT_EQ(std::get<KeyEvent>(events[0]).key, "C");
  EXPECT_TRUE(events_of(pressed, pressed, 0.03).empty());
}

TEST(Gamepad, FullSticksAndTriggersGiveFullSpeedBothWays) {
  PadState pad;
  pad.left = {-1, 1};
  pad.right_trigger = 1;
  const auto events = events_of(pad, PadState{}, 0.05);
  ASSERT_EQ(events.size(), 1U);
  const auto& held = std::get<PadEvent>(events[0]);
  EXPECT_EQ(held.left_x, -1);
  EXPECT_EQ(held.left_y, 1);
  EXPECT_EQ(held.push, 1);
  EXPECT_EQ(held.seconds, 0.05);
}

TEST(Script, EveryStepIsRead) {
  const auto steps = parse_script(
      "# a comment\nkey N\nwait 0.5\nscroll 3\nscroll -1 fine\nmove 10 20\nbutton 0 down\n"
      "tissue skin 0.1\nscreenshot a.png\ndisconnect\nconnect\ncamera 10 20 150\nmeasure 1 2 3 4\n"
      "pad 0 0 0.5 0 1 0.2\n",
      "test");
  ASSERT_TRUE(steps) << steps.error().to_string();
  EXPECT_EQ(steps->size(), 13U);
  const auto& fine = std::get<ScrollEvent>(std::get<UserEvent>((*steps)[3]));
  EXPECT_TRUE(fine.fine);
  EXPECT_EQ(fine.notches, -1);
}

TEST(Script, AMistakeIsNamedWithItsLine) {
  for (const char* bad :
       {"wait", "wait -1", "key", "scroll 1 coarse", "dance", "button 0 half", "pad 1 2 3"}) {
    const auto steps = parse_script(std::string("key N\n") + bad, "demo");
    ASSERT_FALSE(steps) << bad;
    EXPECT_EQ(steps.error().where, "demo:2");
  }
}

}  // namespace
}  // namespace artus
