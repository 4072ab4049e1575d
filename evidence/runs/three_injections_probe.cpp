// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/evidence/runs/three_injections_probe.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "artus/detail/core/noise.h"
#include "artus/detail/core/units.h"

namespace artus {
namespace {

constexpr double kTouchTime = 0.1;   // s, when the hand begins to lower the probe; assumed
constexpr double kLowerTime = 0.5;   // s from held to leaning, and back; assumed
constexpr double kSlideTime = 1.2;   // s at most to slide to another line; as the needle's turn
constexpr double kSteadyTime = 0.3;  // s after touching or sliding until the force is steady

/// From 0 to 1 with the least jerk. Source [Flash1985].
double ease(double share) {
  const double s = std::clamp(share, 0.0, 1.0);
  return s * s * s * (10 - 15 * s + 6 * s * s);
}

constexpr double kFar = 0.03;  // m; assumed: less than a footprint's length is slid

/// Whether a seat is too far for the probe to be slid there: it is lifted and set down again.
bool is_far(const Pose& from, const Pose& to, double far) {
  constexpr double kSteep = 30 * kDegree;
  const Eigen::AngleAxisd turn(Eigen::Matrix3d(from.linear().transpose() * to.linear()));
  return (to.translation() - from.translation()).norm() > far || std::abs(turn.angle()) > kSteep;
}

/// Whether the probe should be pressed and still at `t`: not being lowered, slid or lifted.
bool is_held(const ThreeInjections& run, double t) {
  constexpr double kSame = 1e-4;  // m and rad between seats of one line
  if (t < kTouchTime + kLowerTime + 2 * kSteadyTime || t > run.moments.back().time) return false;
  for (std::size_t i = 0; i + 1 < run.moments.size(); ++i) {
    const NamedMoment& from = run.moments[i];
    const NamedMoment& to = run.moments[i + 1];
    const double end = std::min(from.time + kSlideTime, to.time) + 2 * kSteadyTime;
    const bool slides = !from.X_JP_seat.isApprox(to.X_JP_seat, kSame);
    if (slides && t >= from.time && t < end) return false;
  }
  return true;
}

/// J given to the needle's hand, all passes together.
double needle_energy(const ThreeInjections& run) {
  double sum = 0;
  for (std::size_t i = 0; i < run.rows.size(); ++i)
    if (i + 1 == run.rows.size() || run.rows[i + 1].pass != run.rows[i].pass)
      sum += run.rows[i].energy_to_hand;
  return sum;
}

Claim claim_energy(const ThreeInjections& run, bool gives_way) {
  const double probe = run.probe.back().energy_to_hand;
  if (gives_way)
    return claim_at_most({ClaimKind::input, "the tissue between the hands is built to give none"},
                         "both hands: energy given over the whole run", probe + needle_energy(run),
                         0, "J");
  return claim_at_most({ClaimKind::input, "the contact is built to give none"},
                       "probe: energy given to the hand over the whole run", probe, 0, "J");
}

}  // namespace

ProbeIntention intend_probe(std::span<const NamedMoment> moments, double t, double far) {
  ProbeIntention out;
  out.lift = 1 - ease((t - kTouchTime) / kLowerTime) +
             ease((t - moments.back().time - kSteadyTime) / kLowerTime);
  const auto after = std::find_if(moments.begin(), moments.end(),
                                  [t](const NamedMoment& moment) { return moment.time > t; });
  if (after == moments.begin() || after == moments.end()) {
    out.X_JP = (after == moments.begin() ? moments.front() : moments.back()).X_JP_seat;
    return out;
  }
  const NamedMoment& from = *(after - 1);
  const double duration = std::min(kSlideTime, after->time - from.time);
  const double done = (t - from.time) / duration;
  const bool lifts = is_far(from.X_JP_seat, after->X_JP_seat, far);
  const double share = lifts ? ease(3 * done - 1) : ease(done);
  const Pose& a = from.X_JP_seat;
  const Pose& b = after->X_JP_seat;
  const Eigen::Quaterniond turn =
      Eigen::Quaterniond(a.linear()).slerp(share, Eigen::Quaterniond(b.linear()));
  out.X_JP.linear() = turn.normalized().toRotationMatrix();
  out.X_JP.translation() = (1 - share) * a.translation() + share * b.translation();
  if (lifts) {
    out.lift = std::min(1.0, out.lift + ease(3 * done) - ease(3 * done - 2));
    out.rise = (b.translation() - a.translation()).norm() / 2;  // clears a body as round as that
  }
  return out;
}

void run_probe_hand(const std::shared_ptr<const Scene>& scene, ThreeInjections& run) {
  const double rate = run.options.rate_hz;
  ProbeHandParams params = run.options.probe;
  params.hand.seed = mix_bits(run.options.seed);
  RigidProbeHand hand(scene, params, rate, run.moments.front().X_JP_seat);
  run.probe.reserve(run.rows.size());
  for (std::size_t i = 0; i < run.rows.size(); ++i) {
    run.probe.push_back(hand.step([&run](double t) { return intend_probe(run.moments, t, kFar); }));
  }
  ProbeContactModel contact(scene, params.contact);
  for (NamedMoment& moment : run.moments) {
    const auto tick = static_cast<std::size_t>(std::lround(moment.time * rate));
    const ProbeHandRow& row = run.probe[std::min(tick, run.probe.size() - 1)];
    static_cast<void>(contact.step(row.X_JP));
    moment.X_JP = row.image_pose();
    moment.coverage.assign(contact.coverage().begin(), contact.coverage().end());
  }
}

void claim_probe(ThreeInjections& run, bool gives_way) {
  const ProbeContactParams& contact = run.options.probe.contact;
  const double friction = contact.gel ? contact.gel_friction : contact.dry_friction;
  double off_skin = 0;
  double over_coulomb = 0;
  double pressed = 0;
  std::size_t held = 0;
  std::uint32_t faults = 0;
  for (std::size_t i = 0; i < run.probe.size(); ++i) {
    const ProbeHandRow& row = run.probe[i];
    faults |= row.status & TickStatus::kFaults;
    if (row.contact_share == 0) {
      off_skin = std::max(off_skin, row.normal_force + row.edge_force.norm() + row.friction.norm() +
                                        row.torque.norm());
    } else {
      over_coulomb = std::max(over_coulomb, row.friction.norm() - friction * row.normal_force);
    }
    if (!is_held(run, run.rows[i].time)) continue;
    pressed += row.normal_force;
    ++held;
  }
  const double mean = held > 0 ? pressed / static_cast<double>(held) : 0;
  run.claims.push_back(claim_at_most({ClaimKind::input, "no force outside the body"},
                                     "probe: force and torque off the skin", off_skin, 0, ""));
  run.claims.push_back(claim_near({ClaimKind::input, "the hand's press_force"},
                                  "probe: mean force of the skin while it is held", mean,
                                  run.options.probe.press_force, 0.02, "N"));
  if (!gives_way)
    run.claims.push_back(claim_at_most({ClaimKind::input, "Coulomb's law"},
                                       "probe: friction beyond Coulomb's", over_coulomb, 1e-9,
                                       "N"));
  run.claims.push_back(claim_energy(run, gives_way));
  run.claims.push_back(claim_at_most({ClaimKind::input, "the guard's limits"},
                                     "probe: ticks in fault (status bits seen)",
                                     static_cast<double>(faults), 0, ""));
}

}  // namespace artus
