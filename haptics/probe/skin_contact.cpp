// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/haptics/probe/skin_contact.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace artus {
namespace {

using Row = FaceDepths::Row;

constexpr double kSlack = 0.9;  // of what a correction may take: at its bound it would stick
constexpr double kShear = 500;  // N/m of skin sheared before it slips; assumed
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNear = 10e-6;  // m of depth: a face that came from nowhere has arrived
constexpr double kNone = 1e-12;  // N/m: what is divided by is more
constexpr double kFaded = 1e-6;  // N, what an arm holds less of is over

TissueCurve between(const TissueCurve& a, const TissueCurve& b, double share) noexcept {
  return {a.stiffness + share * (b.stiffness - a.stiffness),
          a.hardening + share * (b.hardening - a.hardening),
          a.slope_x + share * (b.slope_x - a.slope_x), a.slope_y + share * (b.slope_y - a.slope_y)};
}

/// Force and energy of all points.
struct Sum {
  double force = 0;
  double energy = 0;
};
Sum sum_of(const Row& k, const UnitCurve& unit) noexcept {
  return {(k * unit.force).sum(), (k * unit.energy).sum()};
}

}  // namespace

SkinContact::SkinContact(const SkinContactParams& params)
    : params_(params),
      dt_(1 / params.tick_rate),
      slow_step_(1 - std::exp(-dt_ / params.slow_time)),
      fast_step_(1 - std::exp(-dt_ / params.fast_time)) {
  ARTUS_REQUIRE(params.tick_rate > 0 && params.slow_time > 0 && params.fast_time > 0 &&
                    params.correction_time > 0,
                "rates and times above zero");
  ARTUS_REQUIRE(params.slow >= 0 && params.fast >= 0 && params.friction >= 0,
                "shares and a coefficient of friction");
}

/// A surface from before may be felt on, but never off the skin.
Row SkinContact::felt_depth(const Row& offset) const noexcept {
  return face_.depth() + offset.min(face_.depth().max(0));
}

void SkinContact::take(const ProbePacket& packet) noexcept {
  if (packet.number == 0 || !is_packet(packet) || !(packet.spacing_x > 0)) return;
  const Row before = felt_depth(offset_);
  packet_ = packet;
  R_JF_ = frame_of(packet).linear();
  face_.set_face(packet.length, packet.width);
  if (!X_JP_) return;
  face_.look(packet_, *X_JP_);
  offset_ = before - face_.depth();
}

/// A face that comes from nowhere into the tissue, after a pause or where nothing was known, feels
/// no more than had it just touched; the rest comes at the corrections' slew, which is its ramp.
void SkinContact::start(const Pose& X_JP) noexcept {
  face_.look(packet_, X_JP);
  offset_ = -face_.depth().max(0);
  entering_ = true;
  slow_.setZero();
  fast_.setZero();
  grip_.reset();
  curve_ = packet_.curve;
}

/// Goes `share` of the way to what the newest packet says, as far as slew and account let it.
void SkinContact::learn(double share) noexcept {
  const double gain = 1 + params_.slow + params_.fast;
  const Row old_k = curve_.stiffness * face_.shares(curve_);
  const Sum old = sum_of(old_k, unit_curve(felt_depth(offset_), curve_.hardening));
  const auto go = [&](double by) {
    const TissueCurve curve = between(curve_, packet_.curve, by);
    const Row offset = (1 - by) * offset_;
    return sum_of(curve.stiffness * face_.shares(curve),
                  unit_curve(felt_depth(offset), curve.hardening));
  };
  const Sum next = go(share);
  const double force = std::abs(next.force - old.force);
  const double allowed = params_.correction_slew * dt_;
  if (force > kSlack * allowed) share *= kSlack * allowed / force;
  const double account = entering_ ? kInfinity : tank_;
  double cost = gain * (next.energy - old.energy);
  if (cost > kSlack * account) share *= kSlack * account / cost;
  cost = share > 0 ? gain * (go(share).energy - old.energy) : 0;
  if (cost > account) return;
  if (!entering_) tank_ -= std::max(0.0, cost);
  const TissueCurve curve = between(curve_, packet_.curve, share);
  const Row scale =
      (old_k > kNone).select(curve.stiffness * face_.shares(curve) / old_k.max(kNone), Row::Ones());
  slow_ *= scale;
  fast_ *= scale;
  curve_ = curve;
  offset_ *= 1 - share;
  entering_ = entering_ && (offset_ < -kNear).any();
}

/// Force of each point as it is now, and what of it fades in this tick.
void SkinContact::press(const Pose& X_JP) noexcept {
  const double slow = params_.slow;
  const double fast = params_.fast;
  const Row k = curve_.stiffness * face_.shares(curve_);
  const UnitCurve unit = unit_curve(felt_depth(offset_), curve_.hardening);
  const Row at_rest = k * unit.force;
  const Row held = slow * slow_ + fast * fast_;
  const Row f = ((1 + slow + fast) * at_rest - held).max(0);
  // Power that the arms swallow: of a spring g K whose damper lets go in tau.
  const Row stiffness = (k * unit.stiffness).max(kNone);
  const double swallowed =
      (slow / params_.slow_time * (at_rest - slow_).square() / stiffness).sum() +
      (fast / params_.fast_time * (at_rest - fast_).square() / stiffness).sum();
  tank_ = std::min(params_.tank, tank_ + dt_ * (params_.bleed + 0.5 * swallowed));
  const Row toward = (f > 0).select(at_rest, held / (1 + slow + fast));
  slow_ += slow_step_ * (toward - slow_);
  fast_ += fast_step_ * (toward - fast_);
  const double normal = f.sum();
  if (!(normal > 0)) {
    grip_.reset();
    return;
  }
  share_ = static_cast<double>((f > 0).count()) / static_cast<double>(FaceDepths::kPoints);
  const Eigen::Matrix3d R_FP = R_JF_.transpose() * X_JP.linear();
  Vec3 force = Vec3::Zero();
  Vec3 torque = Vec3::Zero();
  for (Eigen::Index i = 0; i < FaceDepths::kPoints; ++i) {
    const Vec3 point = f[i] * Vec3(face_.slope_x()[i], face_.slope_y()[i], -1);
    force += point;
    torque += (R_FP.col(0) * face_.x()[i] + R_FP.col(1) * face_.y()[i]).cross(point);
  }
  out_.force = R_JF_ * force;
  out_.torque = R_JF_ * torque;
  add_friction(X_JP, normal);
}

/// The skin holds the face until Coulomb's force, and then comes along.
void SkinContact::add_friction(const Pose& X_JP, double normal) noexcept {
  const Vec3& p = X_JP.translation();
  if (!grip_) grip_ = p;
  const Vec3 z = X_JP.linear().col(2);
  Vec3 along = p - *grip_;
  along -= z.dot(along) * z;
  const double limit = params_.friction * normal / kShear;  // m
  const double stretched = along.norm();
  if (stretched > limit) along *= limit / stretched;
  grip_ = p - along;
  out_.force -= kShear * along;
}

const Wrench& SkinContact::step(const std::optional<Pose>& X_JP, std::uint64_t tick) noexcept {
  out_ = {};
  share_ = 0;
  const bool known = packet_.number > 0;
  age_ = known && tick > packet_.tick ? static_cast<double>(tick - packet_.tick) * dt_ : 0;
  if (!X_JP || !known) {
    X_JP_.reset();
    return out_;
  }
  if (X_JP_)
    face_.look(packet_, *X_JP);
  else
    start(*X_JP);
  X_JP_ = X_JP;
  const bool pressed = (face_.depth() > 0).any() || (slow_ > kFaded).any();
  if (!pressed) {
    curve_ = packet_.curve;
    offset_.setZero();
    entering_ = false;
  } else if (!late() || entering_) {
    learn(dt_ / params_.correction_time);
  }
  press(*X_JP);
  return out_;
}

}  // namespace artus
