// SPDX-License-Identifier: AGPL-3.0-or-later
#include "viewer/hand_control.h"

#include <algorithm>

#include "core/units.h"

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
  depth_ += length;
}

void HandControl::drag(double dx, double dy, bool inserted) {
  const Pose X_WP = to_pose(target_.X_WP);
  if (grab_ == Grab::probe) {
    Pose moved = X_WP;
    moved.translation() += X_WP.linear() * Vec3(kSlide * dx, kSlide * dy, 0);
    target_.X_WP = to_plain(moved);
    return;
  }
  Pose X_WN = to_pose(target_.X_WN);
  if (inserted) {  // in the image plane with x, out of it with y
    const Vec3 pivot = X_WN.translation() - std::max(depth_, 0.0) * X_WN.linear().col(2);
    X_WN = turned_about(X_WN, pivot, X_WP.linear().col(1), -kTurn * dx);
    X_WN = turned_about(X_WN, pivot, X_WP.linear().col(0), kTurn * dy);
  } else {
    X_WN.translation() += X_WP.linear() * Vec3(kSlide * dx, kSlide * dy, 0);
  }
  target_.X_WN = to_plain(X_WN);
}

bool HandControl::handle_key(const std::string& key) {
  target_.buttons = 0;
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
    target_ = start_;
    depth_ = 10e-3;
  } else {
    return false;
  }
  return true;
}

bool HandControl::handle(const UserEvent& event, bool inserted) {
  if (const auto* key = std::get_if<KeyEvent>(&event)) return handle_key(key->key);
  if (const auto* move = std::get_if<MoveEvent>(&event)) {
    const double dx = have_cursor_ ? move->x - x_ : 0;
    const double dy = have_cursor_ ? move->y - y_ : 0;
    x_ = move->x;
    y_ = move->y;
    have_cursor_ = true;
    if (grab_ == Grab::nothing) return false;
    drag(dx, dy, inserted);
    return true;
  }
  if (const auto* scroll = std::get_if<ScrollEvent>(&event)) {
    const double notches = scroll->fine ? 0.1 * scroll->notches : scroll->notches;
    if (grab_ == Grab::needle) push(kPush * notches);
    if (grab_ == Grab::probe) {
      const Pose X_WP = to_pose(target_.X_WP);
      target_.X_WP = to_plain(
          turned_about(X_WP, X_WP.translation(), X_WP.linear().col(2), 2 * kDegree * notches));
    }
    return grab_ != Grab::nothing;
  }
  return grab_ != Grab::nothing;
}

}  // namespace artus
