// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/viewer/hand_control.h"

#include "artus/core/units.h"

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

void HandControl::push(double length) {
  Pose X_WN = to_pose(target_.X_WN);
  X_WN.translation() += length * X_WN.linear().col(2);
  target_.X_WN = to_plain(X_WN);
}

void HandControl::slide_probe(double x, double y) {
  Pose X_WP = to_pose(target_.X_WP);
  X_WP.translation() += X_WP.linear() * Vec3(x, y, 0);
  target_.X_WP = to_plain(X_WP);
}

// In the image plane with x, out of it with y: a turn about the entry, or a shift while outside.
void HandControl::steer_needle(double x, double y, double slide, double turn,
                               const std::optional<Vec3>& entry_W) {
  const Pose X_WP = to_pose(target_.X_WP);
  Pose X_WN = to_pose(target_.X_WN);
  if (entry_W) {
    X_WN = turned_about(X_WN, *entry_W, X_WP.linear().col(1), -turn * x);
    X_WN = turned_about(X_WN, *entry_W, X_WP.linear().col(0), turn * y);
  } else {
    X_WN.translation() += X_WP.linear() * Vec3(slide * x, slide * y, 0);
  }
  target_.X_WN = to_plain(X_WN);
}

void HandControl::follow_joint(const Pose& X_WJ_before, const Pose& X_WJ) {
  const Pose moved = X_WJ * X_WJ_before.inverse();
  for (HandTarget* hand : {&start_, &target_}) hand->X_WP = to_plain(moved * to_pose(hand->X_WP));
  target_.X_WN = start_.X_WN;
  ++target_.probe_jumps;
}

bool HandControl::handle_key(const std::string& key) {
  const Grab before = grab_;
  const bool taken = act_on(key);
  if (grab_ != before) have_cursor_ = false;  // the pointer may have been elsewhere since
  return taken;
}

bool HandControl::act_on(const std::string& key) {
  if (key == "N") {
    grab_ = Grab::needle;
  } else if (key == "P") {
    grab_ = Grab::probe;
  } else if (key == "ESCAPE") {
    grab_ = Grab::nothing;
  } else if (key == "W") {
    push(kPush);
  } else if (key == "S") {
    push(-kPush);
  } else if (key == "C") {
    target_.buttons = Button::kCalibrate;
  } else if (key == "X") {
    target_.buttons = Button::kExplore;
  } else if (key == "HOME") {
    const std::uint32_t jumps = target_.probe_jumps;
    target_ = start_;
    target_.probe_jumps = jumps;
  } else {
    return false;
  }
  return true;
}

bool HandControl::handle_move(const MoveEvent& move, const std::optional<Vec3>& entry_W) {
  const double share = !have_cursor_ ? 0 : move.fine ? 0.1 : 1;
  const double dx = share * (move.x - x_);
  const double dy = share * (move.y - y_);
  x_ = move.x;
  y_ = move.y;
  have_cursor_ = true;
  if (grab_ == Grab::probe) slide_probe(kSlide * dx, kSlide * dy);
  if (grab_ == Grab::needle) steer_needle(dx, dy, kSlide, kTurn, entry_W);
  return grab_ != Grab::nothing;
}

bool HandControl::handle_scroll(const ScrollEvent& scroll) {
  const double notches = scroll.fine ? 0.1 * scroll.notches : scroll.notches;
  if (grab_ == Grab::needle) push(kPush * notches);
  if (grab_ == Grab::probe) {
    const Pose X_WP = to_pose(target_.X_WP);
    target_.X_WP = to_plain(
        turned_about(X_WP, X_WP.translation(), X_WP.linear().col(2), 2 * kDegree * notches));
  }
  return grab_ != Grab::nothing;
}

bool HandControl::handle_pad(const PadEvent& pad, const std::optional<Vec3>& entry_W) {
  slide_probe(kPadSlide * pad.seconds * pad.left_x, kPadSlide * pad.seconds * pad.left_y);
  steer_needle(pad.right_x, pad.right_y, kPadSlide * pad.seconds, kPadTurn * pad.seconds, entry_W);
  push(kPadPush * pad.seconds * pad.push);
  return true;
}

bool HandControl::handle(const UserEvent& event, const std::optional<Vec3>& entry_W) {
  if (const auto* key = std::get_if<KeyEvent>(&event)) return handle_key(key->key);
  if (const auto* move = std::get_if<MoveEvent>(&event)) return handle_move(*move, entry_W);
  if (const auto* scroll = std::get_if<ScrollEvent>(&event)) return handle_scroll(*scroll);
  if (const auto* pad = std::get_if<PadEvent>(&event)) return handle_pad(*pad, entry_W);
  return grab_ != Grab::nothing;
}

}  // namespace artus
