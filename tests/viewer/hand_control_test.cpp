// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/viewer/input/hand_control.h"

#include <cmath>

#include <gtest/gtest.h>

#include "artus/detail/core/units.h"
#include "artus/detail/viewer/input/body_contact.h"
#include "artus/detail/viewer/input/gamepad.h"
#include "artus/detail/viewer/input/script.h"
#include "tests/session/session_support.h"

namespace artus {
namespace {

const HandGround kNotInside;

HandGround inside_at(const Vec3& entry_W) {
  HandGround ground;
  ground.entry_W = entry_W;
  return ground;
}

ActionEvent request(Action action) {
  return {action, false};
}

HandTarget start_target() {
  HandTarget target;
  target.X_WN = to_plain(make_pose(Vec3(0, 0, -10e-3), Vec3::UnitZ(), Vec3::UnitX()));
  target.X_WP = to_plain(make_pose(Vec3(0.02, 0, 0), Vec3::UnitZ(), Vec3::UnitX()));
  return target;
}

TEST(HandControl, TheWheelPushesTheGrabbedNeedleAlongItsAxis) {
  HandControl control(start_target());
  EXPECT_FALSE(control.handle(ScrollEvent{4, false}, kNotInside));
  EXPECT_TRUE(control.handle(request(Action::take_needle), kNotInside));
  EXPECT_TRUE(control.handle(ScrollEvent{4, false}, kNotInside));
  EXPECT_NEAR(control.target().X_WN.position[2], -8e-3, 1e-12);
  EXPECT_TRUE(control.handle(ScrollEvent{1, true}, kNotInside));
  EXPECT_NEAR(control.target().X_WN.position[2], -7.95e-3, 1e-12);
}

TEST(HandControl, AnInsertedNeedleTurnsAboutItsEntry) {
  HandControl control(start_target());
  control.handle(request(Action::take_needle), kNotInside);
  control.handle(ScrollEvent{50, false}, kNotInside);  // tip 15 mm beyond the skin at z = 0
  const Pose before = to_pose(control.target().X_WN);
  control.handle(MoveEvent{100, 100}, inside_at(Vec3::Zero()));
  control.handle(MoveEvent{150, 100}, inside_at(Vec3::Zero()));
  const Pose after = to_pose(control.target().X_WN);
  EXPECT_NEAR(after.translation().norm(), 15e-3, 1e-9);
  EXPECT_NEAR(after.translation().normalized().dot(after.linear().col(2)), 1, 1e-9)
      << "the shaft goes through the entry";
  EXPECT_NEAR(std::acos(before.linear().col(2).dot(after.linear().col(2))), 50 * HandControl::kTurn,
              1e-6);
}

TEST(HandControl, AFlickedMouseDoesWhatAHandCan) {
  for (const auto& [dx, dy] : {std::pair{900.0, 0.0}, {0.0, -900.0}, {1700.0, 1200.0}}) {
    HandControl control(start_target());
    control.handle(request(Action::take_needle), kNotInside);
    control.handle(ScrollEvent{50, false}, kNotInside);  // tip 15 mm beyond the skin at z = 0
    control.handle(MoveEvent{0, 0}, inside_at(Vec3::Zero()));
    control.handle(MoveEvent{dx, dy}, inside_at(Vec3::Zero()));
    control.handle(MoveEvent{2 * dx, 2 * dy}, inside_at(Vec3::Zero()));
    const Pose X_WN = to_pose(control.target().X_WN);
    EXPECT_LE(std::acos(X_WN.linear()(2, 2)), HandControl::kMostTurn + 1e-9);
    EXPECT_GT(X_WN.translation().z(), 12e-3) << "the tip stays in the body";
    EXPECT_NEAR(X_WN.translation().norm(), 15e-3, 1e-9);
    control.handle(ScrollEvent{-60, false}, inside_at(Vec3::Zero()));
    control.handle(MoveEvent{2 * dx, 2 * dy}, kNotInside);  // out: the next entry is its own
  }
}

TEST(HandControl, TheWheelPressesThePlungerUnderTheThumbAndNothingElse) {
  HandControl control(start_target());
  EXPECT_EQ(control.target().has_plunger, 0U);
  control.handle(request(Action::take_plunger), kNotInside);
  EXPECT_EQ(control.grab(), Grab::plunger);
  EXPECT_EQ(control.target().has_plunger, 1U);
  EXPECT_EQ(control.target().thumb_force, 0);
  control.handle(ScrollEvent{4, false}, kNotInside);
  control.handle(request(Action::push), kNotInside);
  EXPECT_NEAR(control.target().thumb_force, 5 * HandControl::kThumb, 1e-12);
  control.handle(ScrollEvent{-1, true}, kNotInside);
  EXPECT_NEAR(control.target().thumb_force, 4.9 * HandControl::kThumb, 1e-12);
  control.handle(MoveEvent{0, 0}, kNotInside);
  control.handle(MoveEvent{90, 50}, kNotInside);
  EXPECT_TRUE(to_pose(control.target().X_WN).isApprox(to_pose(start_target().X_WN)));
  EXPECT_TRUE(to_pose(control.target().X_WP).isApprox(to_pose(start_target().X_WP)));
  control.handle(ScrollEvent{1000, false}, kNotInside);
  EXPECT_EQ(control.target().thumb_force, HandControl::kMaxThumb);
  control.handle(ScrollEvent{-1000, false}, kNotInside);
  EXPECT_EQ(control.target().thumb_force, -HandControl::kMaxDraw);
  control.handle(request(Action::take_plunger), kNotInside);
  EXPECT_EQ(control.grab(), Grab::nothing);
  EXPECT_EQ(control.target().has_plunger, 0U);
  EXPECT_EQ(control.target().thumb_force, 0) << "a thumb that is off presses nothing";
}

TEST(HandControl, AGamepadsTriggersPressThePlungerAsFarAsTheyAreHeld) {
  HandControl control(start_target());
  control.handle(request(Action::take_plunger), kNotInside);
  PadEvent pad;
  pad.push = 0.5;
  pad.seconds = 0.02;
  control.handle(pad, kNotInside);
  EXPECT_NEAR(control.target().thumb_force, 0.5 * HandControl::kMaxThumb, 1e-12);
  PadState free;
  PadState held = free;
  held.right_trigger = 1;
  const auto events = events_of(free, held, 0.02);
  ASSERT_EQ(events.size(), 1U) << "that a trigger was let go is told";
  control.handle(events.front(), kNotInside);
  EXPECT_EQ(control.target().thumb_force, 0);
  EXPECT_TRUE(to_pose(control.target().X_WN).isApprox(to_pose(start_target().X_WN)));
}

TEST(HandControl, ShiftMovesWhatIsInHandATenthAsFar) {
  HandControl control(start_target());
  control.handle(request(Action::take_probe), kNotInside);
  control.handle(MoveEvent{0, 0}, kNotInside);
  control.handle(MoveEvent{10, 0, true}, kNotInside);
  EXPECT_NEAR(control.target().X_WP.position[0], 0.0201, 1e-12);
}

TEST(HandControl, TheMouseSlidesTheGrabbedProbeOnTheBody) {
  HandControl control(start_target());
  control.handle(request(Action::take_probe), kNotInside);
  control.handle(MoveEvent{0, 0}, kNotInside);
  control.handle(MoveEvent{10, -20}, kNotInside);
  EXPECT_NEAR(control.target().X_WP.position[0], 0.021, 1e-12);
  EXPECT_NEAR(control.target().X_WP.position[1], -2e-3, 1e-12);
  EXPECT_NEAR(control.target().X_WP.position[2], 0, 1e-12);
}

TEST(HandControl, EscapeLetsGoAndHomeGoesBack) {
  HandControl control(start_target());
  control.handle(request(Action::take_needle), kNotInside);
  control.handle(request(Action::push), kNotInside);
  control.handle(request(Action::let_go), kNotInside);
  EXPECT_EQ(control.grab(), Grab::nothing);
  EXPECT_FALSE(control.handle(MoveEvent{5, 5}, kNotInside));
  control.handle(request(Action::home), kNotInside);
  EXPECT_NEAR(control.target().X_WN.position[2], -10e-3, 1e-15);
}

/// The flat layers of the tests under W's z = 0; bone from 29 mm.
class OverLayers : public ::testing::Test {
 protected:
  OverLayers() { ground_.body = {scene_.get(), Pose::Identity()}; }
  [[nodiscard]] double tip(const HandControl& control) const {
    return control.target().X_WN.position[2];
  }
  std::shared_ptr<const Scene> scene_ = test::make_layered_scene();
  HandGround ground_;
};

TEST_F(OverLayers, TheNeedleGoesNoDeeperThanItsHubHoweverFarItIsPushed) {
  HandControl control(start_target(), 20e-3);
  control.handle(request(Action::take_needle), ground_);
  control.handle(ScrollEvent{200, false}, ground_);
  EXPECT_NEAR(tip(control), 20e-3, 1e-9);
  EXPECT_STREQ(control.refusal(), "hub on the skin");
  control.handle(ScrollEvent{-2, false}, ground_);
  EXPECT_NEAR(tip(control), 19e-3, 1e-9);
  EXPECT_EQ(control.refusal(), nullptr);
}

TEST_F(OverLayers, OnBoneAHandPressesAFewMillimetresAndNoMore) {
  HandControl control(start_target(), 50e-3);
  control.handle(request(Action::take_needle), ground_);
  control.handle(ScrollEvent{200, false}, ground_);
  EXPECT_NEAR(tip(control), 29e-3 + HandControl::kBeyondBone, 1e-6);
  EXPECT_STREQ(control.refusal(), "on bone");
}

TEST_F(OverLayers, AFlatNeedleIsNotTornOutOfTheSkin) {
  constexpr double kFlat = 18;  // degrees to the skin
  const Vec3 axis(std::cos(kFlat * kDegree), 0, std::sin(kFlat * kDegree));
  for (const auto& [dx, dy] : {std::pair{900.0, 0.0}, {-900.0, 400.0}, {0.0, 1200.0}}) {
    HandTarget start = start_target();
    start.X_WN = to_plain(make_pose(30e-3 * axis, axis, Vec3::UnitY()));
    HandControl control(start);
    ground_.entry_W = Vec3::Zero();
    control.handle(request(Action::take_needle), ground_);
    for (int flick = 0; flick < 6; ++flick)
      control.handle(MoveEvent{flick * dx, flick * dy}, ground_);
    EXPECT_GE(tip(control), 2e-3 - 1e-6) << dx << ' ' << dy;
    EXPECT_NEAR(to_pose(control.target().X_WN).translation().norm(), 30e-3, 1e-9);
  }
}

TEST_F(OverLayers, AWithdrawalIsUndoneAsOne) {
  HandControl control(start_target(), 50e-3);
  control.handle(ScrollEvent{1, false}, ground_);
  control.handle(request(Action::take_needle), ground_);
  control.handle(ScrollEvent{40, false}, ground_);
  ground_.entry_W = Vec3::Zero();
  const double deep = tip(control);
  control.handle(ScrollEvent{-6, false}, ground_);
  control.handle(ScrollEvent{-4, false}, ground_);
  EXPECT_NEAR(tip(control), deep - 5e-3, 1e-9);
  control.handle(request(Action::undo), ground_);
  EXPECT_NEAR(tip(control), deep, 1e-9);
  control.handle(request(Action::undo), ground_);
  EXPECT_STREQ(control.refusal(), "No withdrawal to undo");
}

TEST_F(OverLayers, ATiltedProbeSlidesOnTheSkin) {
  HandControl control(start_target());
  control.handle(request(Action::take_probe), ground_);
  control.handle(MoveEvent{0, 0}, ground_);
  control.handle(MoveEvent{100, 0, false, true}, ground_);  // rocks by 10 degrees
  const Vec3 axis = to_pose(control.target().X_WP).linear().col(2);
  EXPECT_NEAR(std::acos(axis.z()), 10 * 0.017453292519943295, 1e-6);
  control.handle(MoveEvent{150, 0}, ground_);
  const Pose after = to_pose(control.target().X_WP);
  EXPECT_NEAR(after.translation().z(), 0, 1e-6) << "still on the skin";
  EXPECT_GT(std::abs(after.translation().x() - 20e-3), 4e-3);
  EXPECT_NEAR(after.linear().col(2).dot(axis), 1, 1e-6) << "as tilted as before";
}

TEST_F(OverLayers, WhatCannotBeIsRefusedWithItsReason) {
  HandControl control(start_target());
  ground_.has_entry_choice = false;
  control.handle(request(Action::choose_entry), ground_);
  EXPECT_STREQ(control.refusal(),
               "No skin beside the probe here: bring the probe back onto the body");
  ground_.has_entry_choice = true;
  ground_.entry_W = Vec3::Zero();
  control.handle(request(Action::choose_entry), ground_);
  EXPECT_STREQ(control.refusal(), "The needle is in: pull it out before another entry is chosen");
  EXPECT_EQ(control.target().buttons, 0U);
  control.handle(request(Action::explore), ground_);
  EXPECT_STREQ(control.refusal(), "The needle is in: pull it out before going back to exploring");
}

TEST(BodyContact, GapAndSlopeAreThoseOfTheSkin) {
  const auto scene = test::make_layered_scene();
  const BodyContact body{scene.get(), Pose::Identity()};
  const Pose X_WP = make_pose(Vec3(0, 0, -3e-3), Vec3::UnitZ(), Vec3::UnitX());
  EXPECT_NEAR(body.find_gap(X_WP).value_or(1), 3e-3, 1e-9);
  EXPECT_LT((body.find_normal(X_WP).value_or(Vec3::Zero()) + Vec3::UnitZ()).norm(), 1e-9);
  EXPECT_FALSE(body.find_gap(make_pose(Vec3(1, 0, 0), Vec3::UnitZ(), Vec3::UnitX())));
}

TEST(HandControl, AButtonIsAShortPress) {
  HandControl control(start_target());
  control.handle(request(Action::choose_entry), kNotInside);
  EXPECT_EQ(control.target().buttons, Button::kCalibrate);
  control.release();
  EXPECT_EQ(control.target().buttons, 0U);
}

TEST(HandControl, TheProbeStaysOnTheBodyWhenTheJointIsMoved) {
  HandControl control(start_target());
  control.handle(request(Action::take_needle), kNotInside);
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
  control.handle(PadEvent{0, 0, 1, 0, 0, 0.5}, inside_at(Vec3(0, 0, -20e-3)));
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
  EXPECT_EQ(std::get<ActionEvent>(events[0]).action, Action::choose_entry);
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
      "pad 0 0 0.5 0 1 0.2\nkey shift+G\n",
      "test");
  ASSERT_TRUE(steps) << steps.error().to_string();
  ASSERT_EQ(steps->size(), 14U);
  EXPECT_TRUE(std::get<KeyEvent>(std::get<UserEvent>((*steps)[13])).shift);
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
