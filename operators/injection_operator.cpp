// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/operators/injection_operator.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace artus {
namespace {
using Kind = OperatorPhase::Kind;
using Goal = OperatorPhase::Goal;

constexpr double kBoneFeelTime = 0.03;  // s of full force until the operator is sure; assumed
constexpr double kWatchTime = 0.15;     // s in which a tip off its depth is brought back; assumed
constexpr double kWatchSpeed = 2e-3;    // m/s at most meanwhile; assumed
constexpr double kThere = 0.3e-3;       // m off its depth, of a tip that is there; assumed
constexpr double kWaitsFor = 3;         // s more, for which it is waited for; assumed
constexpr double kBoneShare = 0.99;     // of the bone's force counts as full

// Fraction 0 to 1 with zero speed at both ends.
double smooth(double s) noexcept {
  s = std::clamp(s, 0.0, 1.0);
  return s * s * (3 - 2 * s);
}

// m into a layer at which a hand that looks for it stops.
double deepest_in(const OperatorPhase& phase, double thickness) noexcept {
  const double half = 0.5 * thickness;
  return phase.before_floor > 0 ? std::max(half, thickness - phase.before_floor) : half;
}
}  // namespace

OperatorView view_of(const NeedleModel& model) noexcept {
  OperatorView view;
  const NeedleContact& contact = model.contact();
  const NeedleTick& tick = contact.tick();
  if (contact.inserted()) view.region = contact.region();
  for (const ShaftLayer& s : tick.shaft) {
    if (s.region != view.region || tick.depth < s.entry || tick.depth > s.exit) continue;
    view.into_layer = tick.depth - s.entry;
    view.thickness = s.exit - s.entry;
    break;
  }
  view.bone = contact.state() == ContactState::bone &&
              -model.forces().cutting >= kBoneShare * tick.bone.tissue.cutting_force;
  return view;
}

std::optional<ShaftLayer> layer_seen(const NeedleContact& contact, RegionId region,
                                     double planned) noexcept {
  std::optional<ShaftLayer> nearest;
  if (!contact.inserted()) return nearest;
  const auto off = [planned](const ShaftLayer& s) {
    return std::abs(0.5 * (s.entry + s.exit) - planned);
  };
  for (const ShaftLayer& s : contact.tick().shaft)
    if (s.region == region && (!nearest || off(s) < off(*nearest))) nearest = s;
  return nearest;
}

InjectionOperator::InjectionOperator(const Vec3& entry, const Vec3& direction, double start_depth,
                                     std::vector<OperatorPhase> phases)
    : entry_(entry),
      first_direction_(direction),
      start_depth_(start_depth),
      direction_(direction),
      turn_from_(direction),
      x_hint_(direction.unitOrthogonal()),
      reference_(start_depth),
      phases_(std::move(phases)) {}

Pose InjectionOperator::start() const noexcept {
  return make_pose(entry_ + start_depth_ * first_direction_, first_direction_, x_hint_);
}

void InjectionOperator::begin_again(double time) noexcept {
  index_ = 0;
  direction_ = first_direction_;
  reference_ = start_depth_;
  begin_phase(time, start_depth_);
}

void InjectionOperator::begin_phase(double time, double depth) noexcept {
  phase_time_ = time;
  const bool stays = index_ < phases_.size() &&
                     (phases_[index_].kind == Kind::hold || phases_[index_].kind == Kind::let_go);
  if (started_ && stays) reference_ = depth;
  turn_from_ = direction_;
  bone_time_ = -1;
}

bool InjectionOperator::bone_felt(double time, bool now) noexcept {
  if (!now) bone_time_ = -1;
  if (now && bone_time_ < 0) bone_time_ = time;
  return now && time - bone_time_ >= kBoneFeelTime;
}

bool InjectionOperator::goal_met(const OperatorPhase& phase, double time, double depth,
                                 const OperatorView& view) noexcept {
  const double elapsed = time - phase_time_;
  if ((phase.until_flow && view.flows) || (phase.until_given && view.given)) return true;
  const double over = elapsed - phase.duration;
  switch (phase.kind) {
    case Kind::hold:
      if (phase.keeps_depth && view.depth && over < kWaitsFor)
        return over >= 0 && std::abs(*view.depth - phase.depth) < kThere;
      return over >= 0;
    case Kind::turn:
    case Kind::let_go:
    case Kind::wait:
      return over >= 0;
    case Kind::withdraw:
      return depth <= phase.depth;
    case Kind::advance:
      break;
  }
  if (phase.stop_at_bone && bone_felt(time, view.bone)) return true;
  switch (phase.goal) {
    case Goal::depth:
      return depth >= phase.depth;
    case Goal::region:
      return view.region == phase.region && view.into_layer >= 0 &&
             view.into_layer >= std::min(phase.depth, deepest_in(phase, view.thickness));
    case Goal::bone:
      break;
  }
  return bone_felt(time, view.bone) || (phase.depth > 0 && depth >= phase.depth);
}

/// Tissue comes onto a needle that rests, and the eyes on the picture tell the hand.
void InjectionOperator::keep_depth(double too_deep, double since) noexcept {
  reference_ -= since * std::clamp(too_deep / kWatchTime, -kWatchSpeed, kWatchSpeed);
}

const OperatorPhase* InjectionOperator::observe(double time, const Pose& X_JN,
                                                const OperatorView& view) noexcept {
  if (done()) return nullptr;
  const double depth = (X_JN.translation() - entry_).dot(direction_);
  if (!started_) {
    begin_phase(time, depth);
    started_ = true;
  }
  const double since = time - std::exchange(last_time_, time);
  const OperatorPhase& phase = phases_[index_];
  if (phase.kind == Kind::hold && phase.keeps_depth && view.depth)
    keep_depth(*view.depth - phase.depth, since);
  const bool met = goal_met(phase, time, view.depth.value_or(depth), view);
  const bool late = (phase.kind == Kind::advance || phase.kind == Kind::withdraw) &&
                    time - phase_time_ > phase.duration;
  if (!met && !late) return nullptr;
  timed_out_ = timed_out_ || (late && !met);
  const Intention now = intention(time);
  reference_ = (now.X_JN.translation() - entry_).dot(direction_);
  if (phase.kind == Kind::turn) {
    direction_ = phase.direction;
    reference_ = (now.X_JN.translation() - entry_).norm();
  }
  ++index_;
  const double along = (X_JN.translation() - entry_).dot(direction_);
  if (phase.kind == Kind::let_go) reference_ = along;
  begin_phase(time, along);
  return &phase;
}

Intention InjectionOperator::intention(double t) const noexcept {
  Intention want;
  Vec3 direction = direction_;
  double reference = reference_;
  double speed = 0;
  const double elapsed = t - phase_time_;
  if (!done() && started_) {
    const OperatorPhase& phase = phases_[index_];
    if (phase.kind == Kind::advance || phase.kind == Kind::withdraw) {
      speed = phase.kind == Kind::advance ? phase.speed : -phase.speed;
      reference += speed * elapsed;
    } else if (phase.kind == Kind::hold) {
      want.hold = true;
    } else if (phase.kind == Kind::let_go) {
      want.grip = false;
    } else if (phase.kind == Kind::turn) {
      const double share = smooth(elapsed / std::max(phase.duration, 1e-3));
      const Eigen::Quaterniond turn = rotation_between(turn_from_, phase.direction);
      direction = Eigen::Quaterniond::Identity().slerp(share, turn) * turn_from_;
    }
  }
  want.X_JN = make_pose(entry_ + reference * direction, direction, x_hint_);
  want.velocity = speed * direction;
  return want;
}

}  // namespace artus
