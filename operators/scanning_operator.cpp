// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/operators/scanning_operator.h"

#include <algorithm>
#include <cmath>

#include "artus/detail/core/noise.h"
#include "artus/detail/core/units.h"
#include "artus/detail/operators/thumb_dose.h"

namespace artus {
namespace {

constexpr double kGlance = 0.05;       // s
constexpr double kApproach = 10e-3;    // m above the skin at the start
constexpr double kSettle = 1;          // s before the needle moves
constexpr double kHold = 1.5;          // s
constexpr double kOut = 20e-3;         // m/s
constexpr double kSearchSpeed = 3e-3;  // m/s
constexpr double kSearchTime = 5;      // s
constexpr double kBold = 5e-3;         // m
constexpr double kTooFar = 8e-3;       // m past the target where anyone stops
constexpr double kTent = 5e-3;         // m past the target while its wall holds; assumed
constexpr double kAppear = 2e-3;       // m beyond where the tip should have come into the picture
constexpr double kNoticed = 0.3e-3;    // m off where it came to rest, which is seen; assumed
constexpr double kKeepSpeed = 2e-3;    // m/s at most meanwhile; assumed
constexpr double kLearning = 0.069;    // a trial

}  // namespace

OperatorSkill expert_skill() {
  return {};
}

OperatorSkill novice_skill(int trials) {
  OperatorSkill novice;
  novice.aim_sd = 8;
  novice.entry_sd = 3e-3;
  novice.view_sd = 1.5e-3;
  novice.view_turn_sd = 5;
  novice.see = 0.4;
  novice.reaction = 0.4;
  novice.unseen_stop = 3e-3;
  novice.advance_unseen = 0.3;
  novice.search_right = 0.5;
  novice.drift = 1e-3;
  novice.follow = 0;
  novice.judge_sd = 2.5e-3;
  novice.correction = 1;
  novice.speed = 12e-3;
  novice.haste = 2;
  novice.aspirate = 0;
  novice.know = 0.35;
  novice.look = 0.2;
  novice.feel = 0.2;
  novice.tremor_rms = 40e-6;
  const OperatorSkill expert = expert_skill();
  const double left = std::pow(1 - kLearning, std::max(0, trials));
  const auto learn = [left](double OperatorSkill::*of, OperatorSkill& a, const OperatorSkill& b) {
    a.*of = b.*of + left * (a.*of - b.*of);
  };
  for (const auto of : {&OperatorSkill::aim_sd,       &OperatorSkill::entry_sd,
                        &OperatorSkill::view_sd,      &OperatorSkill::view_turn_sd,
                        &OperatorSkill::see,          &OperatorSkill::reaction,
                        &OperatorSkill::unseen_stop,  &OperatorSkill::advance_unseen,
                        &OperatorSkill::search_right, &OperatorSkill::drift,
                        &OperatorSkill::follow,       &OperatorSkill::judge_sd,
                        &OperatorSkill::correction,   &OperatorSkill::speed,
                        &OperatorSkill::haste,        &OperatorSkill::aspirate,
                        &OperatorSkill::know,         &OperatorSkill::look,
                        &OperatorSkill::feel,         &OperatorSkill::tremor_rms})
    learn(of, novice, expert);
  return novice;
}

ScanningOperator::ScanningOperator(const OperatorSkill& skill, const ScanPlan& plan,
                                   std::uint64_t seed)
    : skill_(skill), plan_(plan), seed_(seed) {
  const Vec3 direction = (plan.target - plan.entry).normalized();
  const Vec3 aside = plan.X_JP.linear().col(1);
  const Vec3 across = direction.cross(aside).norm() > 1e-6
                          ? Vec3(direction.cross(aside).normalized())
                          : direction.unitOrthogonal();
  x_hint_ = aside;
  entry_ = plan.entry +
           skill.entry_sd * (gauss() * aside + gauss() * direction.cross(across).normalized());
  const Vec3 aim = (plan.target - entry_).normalized();
  direction_ = (Eigen::AngleAxisd(skill.aim_sd * kDegree * gauss(), across) *
                Eigen::AngleAxisd(skill.aim_sd * kDegree * gauss(), aside) * aim)
                   .normalized();
  judged_ = skill.judge_sd * gauss();
  plane_ = skill.view_sd * gauss();
  plane_turn_ = skill.view_turn_sd * kDegree * gauss();
  drift_ = skill.drift * (draw() < 0.5 ? -1 : 1);
  begin(Phase::approach, 0);
  phase_distance_ = -kApproach;
}

double ScanningOperator::draw() noexcept {
  return uniform_noise(seed_, draws_++);
}

double ScanningOperator::gauss() noexcept {
  return normal_noise(mix_bits(seed_), draws_++);
}

double ScanningOperator::depth_meant(double t) const noexcept {
  return phase_distance_ + speed_ * (t - phase_time_);
}

void ScanningOperator::begin(Phase phase, double time) noexcept {
  phase_distance_ = depth_meant(time);
  phase_time_ = time;
  phase_ = phase;
  speed_ = 0;
  rested_.reset();
  if (phase == Phase::advance) speed_ = skill_.speed;
  if (phase == Phase::withdraw) speed_ = -kOut;
  follow(time, 0);
  if (phase != Phase::advance) plane_speed_ = 0;
}

/// The probe hand drifts, and goes after the needle as far as it knows how.
void ScanningOperator::follow(double time, double offset) {
  plane_ += plane_speed_ * (time - plane_time_);
  plane_time_ = time;
  plane_speed_ = drift_ + std::clamp(skill_.follow * offset, -kSearchSpeed, kSearchSpeed);
}

/// Turns the line about the entry toward the target, as far as a glance's time allows.
void ScanningOperator::correct(const Pose& X_JN) {
  const Vec3 left = plan_.target - X_JN.translation();
  if (left.norm() < 4e-3) return;
  const Vec3 wanted = (plan_.target - entry_).normalized();
  const Eigen::AngleAxisd turn(rotation_between(direction_, wanted));
  const double most = skill_.correction * kDegree * kGlance;
  direction_ = Eigen::AngleAxisd(std::min(turn.angle(), most), turn.axis()) * direction_;
}

void ScanningOperator::advance(double time, const Pose& X_JN, const ScanGlance& glance, bool seen) {
  const double left = (plan_.target + glance.moved - X_JN.translation()).dot(direction_) + judged_;
  const double lag = skill_.reaction * skill_.speed;
  if (seen) {
    if (seen_time_ < 0) seen_time_ = time;
    seen_depth_ = glance.depth;
    bold_until_ = 0;
    if (time - seen_time_ >= skill_.reaction) correct(X_JN);
  } else {
    seen_time_ = -1;
  }
  const bool there = left <= lag && (seen || bold_until_ > 0 || left < 0);
  // A wall that tents has come along with the tip: whoever knows goes on until it is felt to give.
  if (there && glance.tents && !feels_tent_) feels_tent_ = draw() < skill_.feel;
  const bool goes_on = there && glance.tents && *feels_tent_ && left > -kTent;
  if (glance.stuck || left < -kTooFar || (there && !goes_on)) {
    begin(Phase::hold, time);
    // As it gives, the hand stops pushing.
    if (feels_tent_ == true)
      phase_distance_ = std::min(phase_distance_, (X_JN.translation() - entry_).dot(direction_));
    return;
  }
  phase_distance_ = depth_meant(time);
  phase_time_ = time;
  speed_ = left < 6e-3 ? 0.5 * skill_.speed : skill_.speed;
  const bool not_yet = seen_depth_ <= 0 && glance.depth < plan_.appears + kAppear;
  if (seen || not_yet || glance.depth < bold_until_) return;
  if (glance.depth - std::max(seen_depth_, plan_.appears) < skill_.unseen_stop) return;
  if (draw() < skill_.advance_unseen)
    bold_until_ = glance.depth + kBold;
  else
    begin(Phase::search, time);
}

/// The needle rests until all is given, where it came to be in the tissue: that comes onto a needle
/// at rest, as the picture shows. When the line does not split, or pushes back, it is moved a
/// little toward where it should be; a thumb that feels resistance lets go meanwhile.
void ScanningOperator::hold(double time, const Pose& X_JN, const ScanGlance& glance, bool seen) {
  const double to_target = (plan_.target + glance.moved - X_JN.translation()).dot(direction_);
  if (!rested_) rested_ = to_target;
  const double off = to_target - *rested_;
  if (seen && std::abs(off) > kNoticed)
    phase_distance_ += std::clamp(off, -kKeepSpeed * kGlance, kKeepSpeed * kGlance);
  const bool resists = glance.resists && !eases(time);
  if (time - phase_time_ < kHold && !resists) return;
  if (glance.given) {
    begin(Phase::withdraw, time);
  } else if ((glance.astray || resists) && nudges_ < Redirection::kMost) {
    ++nudges_;
    if (draw() >= (resists ? skill_.feel : skill_.look)) return;
    if (resists) eases_until_ = time + Redirection::kEase;
    if (glance.tents) {
      feels_tent_ = true;
      begin(Phase::advance, time);
      return;
    }
    phase_distance_ += std::copysign(Redirection::kNudge, to_target);
    phase_time_ = time;
    rested_.reset();
  }
}

/// The probe hand looks for the needle; a good one moves toward it.
void ScanningOperator::search(double time, const ScanGlance& glance, bool seen) {
  const double plane = plane_ + plane_speed_ * (time - plane_time_);
  if (seen || time - phase_time_ > kSearchTime) {
    seen_depth_ = glance.depth;
    begin(Phase::advance, time);
    return;
  }
  const bool right = draw() < skill_.search_right;
  const double toward = glance.offset > 0 ? 1 : -1;
  plane_ = plane;
  plane_time_ = time;
  const double speed = std::min(kSearchSpeed, std::abs(glance.offset) / kGlance / 2);
  plane_speed_ = (right ? toward : -toward) * speed;
}

void ScanningOperator::look(double time, const Pose& X_JN, const ScanGlance& glance) {
  const bool seen = glance.visible && draw() < skill_.see;
  if (time > plan_.time_limit && phase_ != Phase::withdraw && phase_ != Phase::done)
    begin(Phase::withdraw, time);
  switch (phase_) {
    case Phase::approach:
      follow(time, glance.offset);
      if (time - phase_time_ >= kSettle) begin(Phase::advance, time);
      break;
    case Phase::advance:
      if (glance.depth <= 0) seen_depth_ = 0;
      follow(time, glance.offset);
      advance(time, X_JN, glance, seen);
      break;
    case Phase::search:
      search(time, glance, seen);
      break;
    case Phase::hold:
      hold(time, X_JN, glance, seen);
      break;
    case Phase::withdraw:
      if (depth_meant(time) <= -kApproach) begin(Phase::done, time);
      break;
    case Phase::done:
      break;
  }
}

Intention ScanningOperator::intention(double t) const noexcept {
  Intention want;
  want.X_JN = make_pose(entry_ + depth_meant(t) * direction_, direction_, x_hint_);
  want.velocity = speed_ * direction_;
  want.hold = phase_ == Phase::hold || phase_ == Phase::search;
  return want;
}

Pose ScanningOperator::probe(double t) const noexcept {
  Pose pose = plan_.X_JP;
  pose.linear() = pose.linear() * Eigen::AngleAxisd(plane_turn_, Vec3::UnitZ()).toRotationMatrix();
  const double plane = plane_ + plane_speed_ * (t - plane_time_);
  pose.translation() += plane * plan_.X_JP.linear().col(1);
  return pose;
}

}  // namespace artus
