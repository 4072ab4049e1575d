// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/haptics/needle/insertion_line.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "artus/detail/haptics/needle/insertion_cone.h"

namespace artus {
namespace {
constexpr double kGrazing = 0.1;      // cosine below which a line runs along the skin
constexpr double kFinestStep = 4e-6;  // m, of a hand's 40 mm/s in a tick at 10 kHz
constexpr int kMaxParts = 16;
constexpr double kQuarterTurn = 1.5707963267948966;  // rad

double angle_between(const Vec3& a, const Vec3& b) noexcept {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

// The unit vector at `angle` from `from` on the way to `to`.
Vec3 turned(const Vec3& from, const Vec3& to, double angle) noexcept {
  const Vec3 across = to - from * from.dot(to);
  const double norm = across.norm();
  if (!(norm > 0)) return from;
  return (std::cos(angle) * from + std::sin(angle) / norm * across).normalized();
}

double fourth_power(double x) noexcept {
  return x * x * x * x;
}

}  // namespace

void InsertionLine::start(const Vec3& tip, const Vec3& axis, double depth,
                          const Vec3& skin_normal) noexcept {
  axis_ = axis;
  first_axis_ = axis;
  entry_ = tip - depth * axis;
  skin_normal_ = std::abs(skin_normal.dot(axis)) > kGrazing ? skin_normal : Vec3(-axis);
  deepest_ = depth;
  shallowest_ = std::min(depth, params_.near_skin);
  last_tip_ = tip;
  last_own_axis_ = axis;
}

LineChange InsertionLine::follow(const Vec3& tip, const Vec3& own_axis) noexcept {
  LineChange change;
  const Vec3 from = last_tip_;
  const Vec3 from_axis = last_own_axis_;
  const double parts =
      std::clamp(std::ceil((tip - from).norm() / kFinestStep), 1.0, static_cast<double>(kMaxParts));
  for (double part = 1; part < parts; ++part) {
    const double share = part / parts;
    step(from + share * (tip - from), (from_axis + share * (own_axis - from_axis)).normalized(),
         change);
  }
  step(tip, own_axis, change);
  last_tip_ = tip;
  last_own_axis_ = own_axis;
  return change;
}

void InsertionLine::step(const Vec3& tip, const Vec3& own_axis, LineChange& change) noexcept {
  const double before = depth(tip);
  deepest_ = std::max(deepest_, before);
  shallowest_ = std::min(params_.near_skin, std::max(shallowest_, before - params_.play));
  if (before < shallowest_) let_go(tip, own_axis, change);
  turn(tip, change);
  slide(tip, own_axis, change);
  change.gain += depth(tip) - before;
}

// The line through `on_line` along `axis`; its entry stays on the skin. A share of how far it was
// from the needle's own axis is left, of the first one likewise.
void InsertionLine::approach(const Vec3& on_line, const Vec3& own_axis, double share) noexcept {
  const double in_before = (on_line - entry_).dot(axis_);
  axis_ = turned(own_axis, axis_, share * angle_between(own_axis, axis_));
  first_axis_ = turned(own_axis, first_axis_, share * angle_between(own_axis, first_axis_));
  const double slope = axis_.dot(skin_normal_);
  const double in =
      std::abs(slope) > kGrazing ? (on_line - entry_).dot(skin_normal_) / slope : in_before;
  entry_ = on_line - in * axis_;
}

// Near the skin, each millimetre out lets go of its share of the line.
void InsertionLine::let_go(const Vec3& tip, const Vec3& own_axis, LineChange& change) noexcept {
  const double before = depth(tip);
  if (before <= 0) return;  // the tip is outside
  change.moved = true;
  const double share = before / shallowest_;
  const Vec3 foot = entry_ + before * axis_;
  approach(tip + share * (foot - tip), own_axis, share);
  deepest_ = depth(tip) + share * (deepest_ - before);
  shallowest_ = before;
  change.kept *= share;
}

// Tissue holds a tip aside by no more than it is deep, and turns it the less the shallower it is:
// a needle at the skin slides along it, as one that is a hair outside.
void InsertionLine::slide(const Vec3& tip, const Vec3& own_axis, LineChange& change) noexcept {
  const double before = depth(tip);
  const double in = std::max(0.0, before);
  const Vec3 foot = entry_ + before * axis_;
  const double off = (foot - tip).norm();
  const double angle = angle_between(own_axis, axis_);
  const double max = in / params_.near_skin * kQuarterTurn;
  if (off <= in && angle <= max) return;
  change.moved = true;
  const double slid = std::max(0.0, off - in);
  const double turned = std::max(0.0, angle - max) * in;
  const Vec3 on_line = slid > 0 ? Vec3(tip + in / off * (foot - tip)) : foot;
  approach(on_line, own_axis, angle > max ? max / angle : 1.0);
  deepest_ += depth(tip) - before;
  change.kept *= std::exp(-(slid + turned) / params_.drag);
}

// How far the tip may be off a line, m.
double InsertionLine::band(double depth) const noexcept {
  const double withdrawn = std::min(deepest_ - depth, params_.withdrawal);
  if (withdrawn <= 0 || depth <= 0) return std::numeric_limits<double>::infinity();
  return std::max(params_.deviation, params_.angle * depth) *
         fourth_power(params_.withdrawal / withdrawn) *
         fourth_power(std::max(1.0, params_.near_skin / depth));
}

// `axis`, or the nearest to it that is no farther from the first one than the cone allows, or than
// the line is already.
Vec3 InsertionLine::inside_cone(const Vec3& axis, double depth) const noexcept {
  const double max =
      std::max(insertion_cone(depth, needle_length_), angle_between(axis_, first_axis_));
  return angle_between(axis, first_axis_) <= max ? axis : turned(first_axis_, axis, max);
}

void InsertionLine::turn(const Vec3& tip, LineChange& change) noexcept {
  const double before = depth(tip);
  const Vec3 to_tip = tip - entry_;
  const double distance = to_tip.norm();
  const double max = band(before);
  if (!((to_tip - before * axis_).norm() > max)) return;
  const Vec3 direction = to_tip / distance;
  const Vec3 axis = inside_cone(turned(direction, axis_, std::asin(max / distance)), distance);
  const double turned = distance * angle_between(axis_, axis);
  if (!(turned > 0)) return;
  change.moved = true;
  change.turned += turned;
  const double kept = std::exp(-turned / params_.drag);
  axis_ = axis;
  const double now = depth(tip);
  const double enough = params_.withdrawal + params_.advance;
  const double withdrawn = deepest_ - before;
  deepest_ = now + std::min(withdrawn, enough) + std::max(0.0, withdrawn - enough) * kept;
  change.kept *= kept;
}

}  // namespace artus
