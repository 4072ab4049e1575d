// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/haptics/needle/needle_contact.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "artus/detail/haptics/needle/insertion_cone.h"

namespace artus {
namespace {
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// What is beyond the region of interest is none: a tip that comes from there is in the air for all
/// that is known.
bool is_tissue(RegionId region) noexcept {
  return region >= kFirstRegion;
}
}  // namespace

const char* to_string(ContactState state) noexcept {
  switch (state) {
    case ContactState::away:
      return "away";
    case ContactState::touching:
      return "touching";
    case ContactState::punctured:
      return "punctured";
    case ContactState::inserting:
      return "inserting";
    case ContactState::stopped:
      return "stopped";
    case ContactState::withdrawing:
      return "withdrawing";
    case ContactState::reinserting:
      return "reinserting";
    case ContactState::bone:
      return "bone";
  }
  return "";
}

NeedleContact::NeedleContact(const ContactParams& params, const PrepunctureParams& prepuncture,
                             const LayerTable& table, double dt) noexcept
    : params_(params),
      prepuncture_(prepuncture),
      table_(&table),
      dt_(dt),
      line_(params.line, params.needle_length),
      skin_(params.membrane_edge),
      motion_(params.motion),
      depths_(params.velocity_window, dt),
      orientations_(params.velocity_window, dt) {
  tick_.dt = dt;
  tick_.table = table_;
  tick_.needle_length = params.needle_length;
}

void NeedleContact::reset() noexcept {
  leave();
  skin_.forget();
  events_ = 0;
  adopt_ = true;
}

void NeedleContact::leave() noexcept {
  inserted_ = false;
  on_bone_ = false;
  state_ = ContactState::away;
  region_ = kOutside;
  soft_region_ = kOutside;
  open_ = 0;
  was_outside_ = true;
  layer_count_ = 0;
  tick_.shaft = {};
  tick_.depth = 0;
  tick_.dimple = 0;
  tick_.velocity = 0;
  tick_.bone_depth = kInfinity;
  tick_.layer = (*table_)[kOutside];
}

double NeedleContact::cone() const noexcept {
  return insertion_cone(tick_.depth, params_.needle_length);
}

Segment NeedleContact::query_segment(const Pose& X_JN) const noexcept {
  const Vec3 tip = X_JN.translation();
  if (!inserted_) {
    const Vec3 axis = X_JN.linear().col(2);
    return {tip - params_.approach * axis, tip + params_.lookahead * axis};
  }
  const double depth = std::max(0.0, (tip - tick_.entry).dot(tick_.axis));
  return {tip - (depth + params_.behind_skin) * tick_.axis, tip + params_.lookahead * tick_.axis};
}

void NeedleContact::store_layers(std::span<const TissueInterval> intervals,
                                 double origin) noexcept {
  layer_count_ = std::min(intervals.size(), kMaxLayers);
  for (std::size_t i = 0; i < layer_count_; ++i) {
    layers_[i] = {intervals[i].entry - origin, intervals[i].exit - origin, intervals[i].region};
  }
  tick_.shaft = std::span<const ShaftLayer>(layers_.data(), layer_count_);
}

void NeedleContact::start_line(const NeedlePlace& place) noexcept {
  inserted_ = true;
  soft_region_ = kOutside;
  tick_.orientation_0 = place.orientation;
  line_.start(place.tip, place.orientation * Vec3::UnitZ(), place.depth, tick_.surface_normal);
  tick_.axis = line_.axis();
  tick_.entry = line_.entry();
  tick_.depth = line_.depth(tick_.tip);
  tick_.dimple = 0;
  tick_.gave_way = place.depth;
  clearance_ = tick_.depth;
  open_ = tick_.depth;
  motion_.reset(hand_place(), Motion::inward);
}

void NeedleContact::adopt(const NeedlePlace& now) noexcept {
  adopt_ = false;
  start_line(now);
  depths_.reset(now.depth + tick_.pushed);
  tick_.velocity = 0;
  motion_.reset(now.depth + tick_.pushed + carried(), Motion::still);
  events_ |= ContactEvent::kAdopted;
}

// How far the skin was pushed in when it gave way, in the way since the last tick.
double NeedleContact::gave_way_at(const LayerHaptics& skin, double strength,
                                  double thickness) const noexcept {
  const double now = tick_.depth;
  const double last = skin_.last_dimple(now);
  if (strength <= 0) return last;
  const double force_last = prepuncture_force(prepuncture_, skin, last, tick_.velocity);
  const double force_now = prepuncture_force(prepuncture_, skin, now, tick_.velocity);
  double share = 1;
  if (force_now > strength) share = std::max(0.0, strength - force_last) / (force_now - force_last);
  return std::max(last, std::min(last + share * (now - last), thickness));
}

// Tip outside, or dimpling the skin: the line is the needle's own axis.
void NeedleContact::approach(const Pose& X_JN, std::span<const TissueInterval> intervals) noexcept {
  const double at_tip = params_.approach;
  std::size_t tip_index = 0;
  while (tip_index + 1 < intervals.size() && intervals[tip_index].exit <= at_tip) ++tip_index;
  const bool inside = !intervals.empty() && is_tissue(intervals[tip_index].region);
  std::size_t first = tip_index;
  if (!inside) {
    adopt_ = false;
    leave();
    depths_.reset(0);
    while (first < intervals.size() && !is_tissue(intervals[first].region)) ++first;
    const double ahead = first < intervals.size() ? intervals[first].entry - at_tip : kInfinity;
    skin_.wait({tick_.tip, tick_.orientation, -ahead});
    return;
  }
  while (first > 0 && is_tissue(intervals[first - 1].region)) --first;
  const double depth = at_tip - intervals[first].entry;
  const NeedlePlace now{tick_.tip, tick_.orientation, depth};
  tick_.axis = X_JN.linear().col(2);
  tick_.entry = tick_.tip - depth * tick_.axis;
  tick_.depth = depth;
  tick_.surface_normal = intervals[first].entry_normal;
  store_layers(intervals, intervals[first].entry);
  if (was_outside_) {
    depths_.reset(0);
    was_outside_ = false;
  }
  tick_.velocity = (hand_depth() - depths_.push(hand_depth())) / depths_.duration(dt_);
  if (adopt_) return adopt(now);
  const LayerHaptics& skin = (*table_)[intervals[first].region];
  const double thickness = intervals[first].exit - intervals[first].entry;
  const double force = prepuncture_force(prepuncture_, skin, depth, tick_.velocity);
  skin_.touch(now);
  const double strength = skin_.wholeness() * skin.tissue.puncture_force;
  if (strength > 0 && still_holds(skin, depth, force, strength) && depth < thickness) {
    skin_.remember(now);
    state_ = ContactState::touching;
    region_ = intervals[first].region;
    tick_.membrane = skin;
    tick_.dimple = depth;
    return;
  }
  start_line(skin_.between(now, gave_way_at(skin, strength, thickness)));
  tear(std::min(force, strength), depth);
  events_ |= ContactEvent::kSkinPunctured;
}

// Whether a membrane of so much strength holds `force`, N. Tissue follows the tip later than a
// device's steps of place come, so that each is felt as a short peak; which of them the loop's
// ticks meet must not decide: there it gives way to what lasts, or at once to what is far more.
bool NeedleContact::still_holds(const LayerHaptics& membrane, double dimple, double force,
                                double strength) noexcept {
  constexpr double kGiveWay = 5e-3;  // s; assumed: of two or three such steps
  constexpr double kFarMore = 1.25;  // assumed: a step of 0.055 mm adds 0.14 N to 1 N or more
  if (!gives_way_) return force < strength;
  lasting_ += (1 - std::exp(-dt_ / kGiveWay)) * (dimple - lasting_);
  return force < kFarMore * strength &&
         prepuncture_force(prepuncture_, membrane, lasting_, tick_.velocity) < strength;
}

void NeedleContact::tear(double force, double dimple) noexcept {
  tick_.torn += force;
  tick_.torn_dimple = std::max(tick_.torn_dimple, dimple);
}

// The line may follow the tip; what is remembered by depth goes with it.
void NeedleContact::follow_line(const Pose& X_JN) noexcept {
  const LineChange change = line_.follow(tick_.tip, X_JN.linear().col(2));
  if (!change.moved) return;
  const double ahead = open_ - tick_.depth;
  tick_.axis = line_.axis();
  tick_.entry = line_.entry();
  const double deeper = line_.depth(tick_.tip) - tick_.depth;
  tick_.depth += deeper;
  for (ShaftLayer& layer : std::span(layers_.data(), layer_count_)) {
    layer.entry += deeper;
    layer.exit += deeper;
  }
  tick_.line_gain = change.gain;
  tick_.line_kept = change.kept;
  tick_.orientation_0 = tick_.orientation.slerp(change.kept, tick_.orientation_0);
  if (ahead > 0) open_ = tick_.depth + change.kept * ahead;
  depths_.shift(change.gain);
  motion_.shift(change.gain);
  if (change.turned > 0) events_ |= ContactEvent::kRedirected;
}

// How far the tip is in the first tissue of its line, m; negative outside.
double NeedleContact::clearance() const noexcept {
  for (const ShaftLayer& s : tick_.shaft) {
    if (is_tissue(s.region)) return std::min(tick_.depth, tick_.depth - s.entry);
  }
  return -kInfinity;
}

void NeedleContact::leave_skin(const Vec3& last_tip, double last_clearance) noexcept {
  const double share = last_clearance > 0 ? last_clearance / (last_clearance - clearance_) : 0;
  skin_.leave(last_tip + share * (tick_.tip - last_tip),
              {tick_.tip, tick_.orientation, clearance_});
  leave();
  events_ = ContactEvent::kExited;
}

// Share of its strength that a membrane has that crosses the line at `depth`.
double NeedleContact::wholeness(double depth) const noexcept {
  const double before_end = open_ - params_.membrane_margin - depth;
  return std::clamp(1 - before_end / params_.membrane_edge, 0.0, 1.0);
}

// A line that comes to graze bone meets it millimetres behind the tip all at once, and loses it as
// suddenly. The tip cannot be farther in than it has moved; and a bevel that was pressed into bone
// leaves it over the depth that it was in, not where its line does.
double NeedleContact::felt_bone(double line_depth) noexcept {
  const double x = tick_.depth;
  const double before = on_bone_ ? bone_ + tick_.line_gain : x;
  bone_ = std::max(line_depth, before - moved_);
  const double left = on_bone_ ? held_ - (tick_.tip - held_tip_).norm() : 0;
  if (left > 0 && left > x - bone_) {
    bone_ = x - left;
    return bone_;
  }
  const Haptic& bone = tick_.bone.tissue;
  const double rise = bone.cutting_force / std::max(bone.wall_stiffness, 1e-6);
  held_ = std::min({x - bone_, rise, params_.bevel});
  held_tip_ = tick_.tip;
  return bone_;
}

// The tip is in this stretch. What its law feels goes over to it on the first stretch in it, so
// that a tip at rest on a border is not in one layer or the other by chance. Two laws mean
// different things by one stiffness: from one to the other there is no passage.
void NeedleContact::feel(const ShaftLayer& stretch, bool skin) noexcept {
  const LayerHaptics before = tick_.layer;
  tick_.layer = (*table_)[stretch.region];
  region_ = stretch.region;
  if (skin || before.cutting != tick_.layer.cutting) return;
  Haptic& felt = tick_.layer.tissue;
  const double share = std::min(1.0, (tick_.depth - stretch.entry) / params_.layer_edge);
  felt.cutting_force = std::lerp(before.tissue.cutting_force, felt.cutting_force, share);
  felt.attracted_force = std::lerp(before.tissue.attracted_force, felt.attracted_force, share);
  felt.wall_stiffness = std::lerp(before.tissue.wall_stiffness, felt.wall_stiffness, share);
}

// The layer that the tip was in a tick ago, -1: none. Its membrane and those before it gave way
// earlier; on a line that moves they come back to strength and hold again, but do not tear twice.
std::ptrdiff_t NeedleContact::last_passed() const noexcept {
  std::ptrdiff_t passed = -1;
  for (std::size_t i = 0; i < layer_count_ && layers_[i].entry <= tick_.depth; ++i) {
    if (layers_[i].region == soft_region_) passed = static_cast<std::ptrdiff_t>(i);
  }
  return passed;
}

// The soft layer at the tip, the membrane that holds it up, and where bone begins.
void NeedleContact::find_tip_layers() noexcept {
  const double x = tick_.depth;
  tick_.dimple = 0;
  tick_.bone_depth = kInfinity;
  region_ = kOutside;
  bool held = false;
  bool skin = true;  // is punctured
  double line_bone = kInfinity;
  const std::ptrdiff_t passed = last_passed();
  for (std::ptrdiff_t i = 0; i < static_cast<std::ptrdiff_t>(layer_count_); ++i) {
    const ShaftLayer& s = layers_[static_cast<std::size_t>(i)];
    const LayerHaptics& layer = (*table_)[s.region];
    if (layer.tissue.hard) {
      if (s.exit <= 0) continue;
      line_bone = s.entry;
      if (!on_bone_ || x > line_bone) {
        tick_.bone = layer;
        bone_region_ = s.region;
      }
      break;
    }
    if (s.entry > x || s.region == kOutside) continue;
    const double strength = skin ? 0 : wholeness(s.entry) * layer.tissue.puncture_force;
    if (!held && strength > 0) {
      const double dimple = x - s.entry;
      const double force = prepuncture_force(prepuncture_, layer, dimple, tick_.velocity);
      const bool holds =
          i > passed ? still_holds(layer, dimple, force, strength) : force < strength;
      if (holds && x < s.exit) {
        held = true;
        if (strength == layer.tissue.puncture_force) {
          open_ = std::min(open_, s.entry);  // its surface may move under a needle that sways
        }
        tick_.dimple = dimple;
        tick_.membrane = layer;
      } else if (i > passed) {
        tear(std::min(force, strength), dimple);
        lasting_ = 0;
        open_ = std::max(open_, s.entry + params_.membrane_margin + params_.membrane_edge);
        events_ |= ContactEvent::kMembranePopped;
      }
    }
    if (!held) feel(s, skin);
    skin = false;
  }
  soft_region_ = region_;
  tick_.bone_depth = felt_bone(line_bone);
  if (x > tick_.bone_depth) region_ = bone_region_;
  if (!held) open_ = std::max(open_, std::min(x, tick_.bone_depth));
}

void NeedleContact::classify() noexcept {
  const double x = tick_.depth;
  const bool beyond_bone = x > tick_.bone_depth;
  if (beyond_bone && !on_bone_) events_ |= ContactEvent::kBoneTouched;
  on_bone_ = beyond_bone;
  constexpr std::uint32_t kPops = ContactEvent::kSkinPunctured | ContactEvent::kMembranePopped;
  if (beyond_bone) {
    state_ = ContactState::bone;
  } else if ((events_ & kPops) != 0) {
    state_ = ContactState::punctured;
  } else if (tick_.dimple > 0) {
    state_ = ContactState::touching;
  } else if (motion_.motion() == Motion::still) {
    state_ = ContactState::stopped;
  } else if (motion_.motion() == Motion::outward) {
    state_ = ContactState::withdrawing;
  } else {
    state_ = x < open_ - params_.motion.band ? ContactState::reinserting : ContactState::inserting;
  }
}

void NeedleContact::update_velocity(const Pose& X_JN) noexcept {
  tick_.orientation = Eigen::Quaterniond(X_JN.linear()).normalized();
  const Eigen::Vector4d before = orientations_.push(tick_.orientation.coeffs());
  if (before.squaredNorm() < 0.5) {
    orientations_.reset(tick_.orientation.coeffs());
    tick_.angular_velocity.setZero();
    return;
  }
  const Eigen::Quaterniond turn = tick_.orientation * Eigen::Quaterniond(before).conjugate();
  const double sign = turn.w() < 0 ? -1 : 1;
  const double norm = turn.vec().norm();
  const double angle = 2 * std::atan2(norm, std::abs(turn.w()));
  tick_.angular_velocity =
      norm > 0 ? Vec3(sign * angle / (norm * orientations_.duration(dt_)) * turn.vec())
               : Vec3(Vec3::Zero());
}

void NeedleContact::update(const Pose& X_JN, std::span<const TissueInterval> intervals,
                           const TipTissue& tissue) noexcept {
  events_ = 0;
  tick_.line_gain = 0;
  tick_.line_kept = 1;
  tick_.torn = 0;
  tick_.torn_dimple = 0;
  const Vec3 last_tip = tick_.tip;
  moved_ = adopt_ ? 0 : (X_JN.translation() - last_tip).norm();
  tick_.tip = X_JN.translation();
  tick_.pushed = tissue.pushed;
  gives_way_ = tissue.gives_way;
  if (tick_.dimple <= 0) lasting_ = 0;
  carried_J_ = tissue.carried_J;
  update_velocity(X_JN);
  if (!inserted_) {
    approach(X_JN, intervals);
    if (!inserted_) return;
  } else {
    tick_.depth = (tick_.tip - tick_.entry).dot(tick_.axis);
    store_layers(intervals, params_.behind_skin);
    const double last_clearance = std::exchange(clearance_, clearance());
    if (clearance_ < 0) return leave_skin(last_tip, last_clearance);
    const double before = depths_.push(hand_depth());
    tick_.velocity = (hand_depth() - before) / depths_.duration(dt_);
    follow_line(X_JN);
  }
  motion_.step(hand_place(), dt_);
  tick_.stillness = motion_.stillness();
  tick_.incoming_speed = std::max(0.0, tick_.velocity);
  find_tip_layers();
  classify();
}

}  // namespace artus
