// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/viewer/input/hand_control.h"

#include <algorithm>
#include <cmath>

#include "artus/detail/core/units.h"

namespace artus {
namespace {

Pose turned_about(const Pose& pose, const Vec3& pivot, const Vec3& axis, double angle) {
  Pose turned = pose;
  const Eigen::AngleAxisd turn(angle, axis);
  turned.linear() = turn.toRotationMatrix() * pose.linear();
  turned.translation() = pivot + turn * (pose.translation() - pivot);
  return turned;
}

}  // namespace

// The tip goes no deeper than the hub lets it, nor far beyond bone.
void HandControl::push(double length, const HandGround& ground) {
  Pose X_WN = to_pose(target_.X_WN);
  const Vec3 axis = X_WN.linear().col(2);
  if (length < 0 && !pulling_ && ground.entry_W) before_pull_ = target_.X_WN;
  pulling_ = length < 0;
  const Vec3 hub = X_WN.translation() - needle_length_ * axis;
  const double reach = needle_length_ + std::max(length, 0.0);
  std::optional<double> skin;  // m from the hub
  if (ground.entry_W)
    skin = (*ground.entry_W - hub).dot(axis);
  else
    skin = ground.body.find_skin(hub, axis, reach);
  if (length > 0 && skin) {
    const Vec3 entry = hub + *skin * axis;
    double most = *skin;  // m until the hub meets the skin
    const char* reason = msgid("hub on the skin");
    const auto bone = ground.body.find_bone(entry, axis, needle_length_);
    const double to_bone = bone ? *skin + *bone + kBeyondBone - needle_length_ : most;
    if (to_bone < most) {
      most = to_bone;
      reason = msgid("on bone");
    }
    if (length > most) {
      length = std::max(most, 0.0);
      refusal_ = reason;
    }
  }
  X_WN.translation() += length * axis;
  target_.X_WN = to_plain(X_WN);
}

// A step in the face's plane; then the skin's slope is followed and the press kept.
void HandControl::slide_probe(double x, double y, const HandGround& ground) {
  const Pose before = to_pose(target_.X_WP);
  Pose after = before;
  after.translation() += before.linear() * Vec3(x, y, 0);
  const auto gap = ground.body.find_gap(before);
  const auto normal = ground.body.find_normal(before);
  const auto next_normal = ground.body.find_normal(after);
  if (gap && normal && next_normal) {
    after.linear() = rotation_between(*normal, *next_normal).toRotationMatrix() * after.linear();
    if (const auto next_gap = ground.body.find_gap(after))
      after.translation() += (*next_gap - *gap) * after.linear().col(2);
  }
  target_.X_WP = to_plain(after);
}

void HandControl::tilt_probe(double rock, double fan) {
  Pose X_WP = to_pose(target_.X_WP);
  X_WP = turned_about(X_WP, X_WP.translation(), X_WP.linear().col(1), rock);
  X_WP = turned_about(X_WP, X_WP.translation(), X_WP.linear().col(0), fan);
  target_.X_WP = to_plain(X_WP);
}

void HandControl::turn_probe(double angle) {
  const Pose X_WP = to_pose(target_.X_WP);
  target_.X_WP = to_plain(turned_about(X_WP, X_WP.translation(), X_WP.linear().col(2), angle));
}

void HandControl::press_probe(double length, const HandGround& ground) {
  Pose X_WP = to_pose(target_.X_WP);
  const auto gap = ground.body.find_gap(X_WP);
  if (length > 0 && gap) length = std::min(length, std::max(0.0, *gap + kDeepestPress));
  X_WP.translation() += length * X_WP.linear().col(2);
  target_.X_WP = to_plain(X_WP);
}

void HandControl::follow_entry(const HandGround& ground) {
  if (!ground.entry_W)
    entered_axis_W_.reset();
  else if (!entered_axis_W_)
    entered_axis_W_ = to_pose(target_.X_WN).linear().col(2);
}

void HandControl::keep_turn(Pose& X_WN, const Vec3& entry_W) const {
  if (!entered_axis_W_) return;
  const Vec3 axis = X_WN.linear().col(2);
  const Vec3 back = axis.cross(*entered_axis_W_);
  const double angle = std::atan2(back.norm(), axis.dot(*entered_axis_W_));
  if (angle > kMostTurn && back.norm() > 1e-9)
    X_WN = turned_about(X_WN, entry_W, back.normalized(), angle - kMostTurn);
}

namespace {

/// Whether the tip lies as deep under the skin as tissue holds it, or as it did before.
bool stays_in(const Pose& X_WN, const Pose& before, const BodyContact& body) {
  constexpr double kHeld = 2e-3;    // m; assumed: a tip nearer to the skin comes out of it
  constexpr double kUnder = 20e-3;  // m
  if (body.scene == nullptr) return true;
  const auto deep = [&](const Pose& X) {
    return -body.scene->signed_distance_to_skin(body.X_WJ.inverse() * X.translation(), kUnder);
  };
  return deep(X_WN) >= std::min(kHeld, deep(before)) - 1e-6;
}

}  // namespace

// In the image plane with x, out of it with y: a turn about the entry, or a shift while outside.
void HandControl::steer_needle(double x, double y, double slide, double turn,
                               const HandGround& ground) {
  const Pose X_WP = to_pose(target_.X_WP);
  Pose X_WN = to_pose(target_.X_WN);
  if (ground.entry_W) {
    const Pose before = X_WN;
    const auto turned = [&](double share) {
      Pose X = turned_about(before, *ground.entry_W, X_WP.linear().col(1), -share * turn * x);
      X = turned_about(X, *ground.entry_W, X_WP.linear().col(0), share * turn * y);
      keep_turn(X, *ground.entry_W);
      return X;
    };
    double share = 1;
    X_WN = turned(share);
    for (int i = 0; i < kLooks && !stays_in(X_WN, before, ground.body); ++i)
      X_WN = turned(i + 1 < kLooks ? share *= 0.7 : 0);
  } else {
    X_WN.translation() += X_WP.linear() * Vec3(slide * x, slide * y, 0);
  }
  target_.X_WN = to_plain(X_WN);
}

void HandControl::follow_joint(const Pose& X_WJ_before, const Pose& X_WJ) {
  const Pose moved = X_WJ * X_WJ_before.inverse();
  for (HandTarget* hand : {&start_, &target_}) hand->X_WP = to_plain(moved * to_pose(hand->X_WP));
  target_.X_WN = start_.X_WN;
  before_pull_.reset();
  ++target_.probe_jumps;
}

void HandControl::place_needle(const PlainPose& X_WN) {
  start_.X_WN = X_WN;
  target_.X_WN = X_WN;
  before_pull_.reset();
}

bool HandControl::take(Grab what) {
  if (grab_ != what) have_cursor_ = false;  // the pointer may have been elsewhere since
  grab_ = what;
  target_.has_plunger = what == Grab::plunger ? 1 : 0;
  target_.thumb_force = 0;
  return true;
}

void HandControl::press_thumb(double force) {
  target_.thumb_force = std::clamp(force, -kMaxDraw, kMaxThumb);
}

bool HandControl::choose_entry(const HandGround& ground) {
  if (ground.entry_W)
    refusal_ = msgid("The needle is in: pull it out before another entry is chosen");
  else if (ground.phase == GesturePhase::inserting)
    refusal_ = msgid("An entry is chosen already: {} goes back to exploring");
  else if (!ground.has_entry_choice)
    refusal_ = msgid("No skin beside the probe here: bring the probe back onto the body");
  else
    target_.buttons = Button::kCalibrate;
  return true;
}

bool HandControl::explore(const HandGround& ground) {
  if (ground.entry_W)
    refusal_ = msgid("The needle is in: pull it out before going back to exploring");
  else
    target_.buttons = Button::kExplore;
  return true;
}

void HandControl::go_home() {
  const std::uint32_t jumps = target_.probe_jumps;
  target_ = start_;
  target_.probe_jumps = jumps;
  target_.has_plunger = grab_ == Grab::plunger ? 1 : 0;
  before_pull_.reset();
}

bool HandControl::undo(const HandGround& ground) {
  if (!before_pull_ || !ground.entry_W) {
    refusal_ = msgid("No withdrawal to undo");
    return true;
  }
  target_.X_WN = *before_pull_;
  before_pull_.reset();
  pulling_ = false;
  return true;
}

bool HandControl::move_with_arrow(Action action, bool fine, const HandGround& ground) {
  if (grab_ == Grab::nothing) return false;
  const double step = fine ? 0.1 * kArrow : kArrow;
  if (action == Action::left) move_in_hand(-step, 0, false, ground);
  if (action == Action::right) move_in_hand(step, 0, false, ground);
  if (action == Action::up) move_in_hand(0, -step, false, ground);
  if (action == Action::down) move_in_hand(0, step, false, ground);
  return true;
}

bool HandControl::handle(Action action, bool fine, const HandGround& ground) {
  refusal_ = nullptr;
  const double step = fine ? 0.1 : 1;
  const double sign = action == Action::pull ? -1 : 1;
  switch (action) {
    case Action::take_needle:
      return take(Grab::needle);
    case Action::take_probe:
      return take(Grab::probe);
    case Action::take_plunger:
      return take(grab_ == Grab::plunger ? Grab::nothing : Grab::plunger);
    case Action::let_go:
      return take(Grab::nothing);
    case Action::push:
    case Action::pull:
      if (grab_ == Grab::probe)
        press_probe(sign * step * kPress, ground);
      else if (grab_ == Grab::plunger)
        press_thumb(target_.thumb_force + sign * step * kThumb);
      else
        push(sign * step * kPush, ground);
      return true;
    case Action::turn_left:
    case Action::turn_right:
      if (grab_ != Grab::probe) return false;
      turn_probe((action == Action::turn_left ? -2 : 2) * kDegree);
      return true;
    case Action::choose_entry:
      return choose_entry(ground);
    case Action::explore:
      return explore(ground);
    case Action::home:
      go_home();
      return true;
    case Action::undo:
      return undo(ground);
    case Action::left:
    case Action::right:
    case Action::up:
    case Action::down:
      return move_with_arrow(action, fine, ground);
    default:
      return false;
  }
}

void HandControl::move_in_hand(double dx, double dy, bool tilt, const HandGround& ground) {
  if (grab_ == Grab::probe && tilt) {
    tilt_probe(kTurn * dx, kTurn * dy);
  } else if (grab_ == Grab::probe) {
    slide_probe(kSlide * dx, kSlide * dy, ground);
  } else if (grab_ == Grab::needle) {
    const double asked = ground.entry_W ? kTurn * std::hypot(dx, dy) : 0;
    const double share = asked > kMostAtOnce ? kMostAtOnce / asked : 1;
    steer_needle(share * dx, share * dy, kSlide, kTurn, ground);
  }
}

bool HandControl::handle_move(const MoveEvent& move, const HandGround& ground) {
  const double share = !have_cursor_ ? 0 : move.fine ? 0.1 : 1;
  const double dx = share * (move.x - x_);
  const double dy = share * (move.y - y_);
  x_ = move.x;
  y_ = move.y;
  have_cursor_ = true;
  if (dx != 0 || dy != 0) move_in_hand(dx, dy, move.tilt, ground);
  return grab_ != Grab::nothing;
}

bool HandControl::handle_scroll(const ScrollEvent& scroll, const HandGround& ground) {
  const double notches = scroll.fine ? 0.1 * scroll.notches : scroll.notches;
  if (grab_ == Grab::needle) push(kPush * notches, ground);
  if (grab_ == Grab::plunger) press_thumb(target_.thumb_force + kThumb * notches);
  if (grab_ == Grab::probe && scroll.tilt)
    press_probe(kPress * notches, ground);
  else if (grab_ == Grab::probe)
    turn_probe(2 * kDegree * notches);
  return grab_ != Grab::nothing;
}

bool HandControl::handle_pad(const PadEvent& pad, const HandGround& ground) {
  const double slide = kPadSlide * pad.seconds;
  if (pad.left_x != 0 || pad.left_y != 0)
    slide_probe(slide * pad.left_x, slide * pad.left_y, ground);
  if (pad.right_x != 0 || pad.right_y != 0)
    steer_needle(pad.right_x, pad.right_y, slide, kPadTurn * pad.seconds, ground);
  if (grab_ == Grab::plunger)
    press_thumb(kMaxThumb * pad.push);
  else if (pad.push != 0)
    push(kPadPush * pad.seconds * pad.push, ground);
  return true;
}

bool HandControl::handle(const UserEvent& event, const HandGround& ground) {
  follow_entry(ground);
  if (const auto* request = std::get_if<ActionEvent>(&event))
    return handle(request->action, request->fine, ground);
  refusal_ = nullptr;
  if (const auto* move = std::get_if<MoveEvent>(&event)) return handle_move(*move, ground);
  if (const auto* scroll = std::get_if<ScrollEvent>(&event)) return handle_scroll(*scroll, ground);
  if (const auto* pad = std::get_if<PadEvent>(&event)) return handle_pad(*pad, ground);
  return grab_ != Grab::nothing;
}

}  // namespace artus
