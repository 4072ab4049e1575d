// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/evidence/validation/soft/probe_hands.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <numbers>
#include <optional>

#include "artus/detail/haptics/passivity.h"
#include "artus/detail/haptics/probe/curve_fit.h"
#include "artus/detail/haptics/probe/skin_contact.h"

namespace artus {
namespace {

constexpr double kStart = 8e-3;       // m above the skin
constexpr double kPressDepth = 3e-3;  // m that a hand with a spring wants
constexpr double kHover = 0.4;        // s before the gesture
constexpr double kSeconds = 2.5;
constexpr double kTurn = 2 * std::numbers::pi;
constexpr double kFastestTurn = 0.02;  // m/s of the face's rim in a twist
constexpr double kForceSlew = 4000;    // N/s, as GuardParams'

struct Range {
  double low = 1e9;
  double high = -1e9;
  void add(double z) {
    low = std::min(low, z);
    high = std::max(high, z);
  }
  [[nodiscard]] double size() const { return high - low; }
};

/// The tissue and what it tells of itself.
class ExponentialTissue {
 public:
  explicit ExponentialTissue(double hardness) : stiffness_(154 * hardness) {}

  [[nodiscard]] ProbePacket packet(const Pose& X_JP, double prior, std::uint64_t number,
                                   std::uint64_t tick) const {
    ProbePacket out;
    out.number = number;
    out.tick = tick;
    for (Eigen::Index i = 0; i < 12; ++i)
      out.X_JF[static_cast<std::size_t>(i)] = i / 4 == i % 4 ? 1 : 0;
    // The frame keeps J's axes, its origin below the face's: the skin is the plane z = 0.
    out.X_JF[3] = X_JP.translation().x();
    out.X_JF[7] = X_JP.translation().y();
    out.spacing_x = out.spacing_y = 5e-3;
    out.length = 40e-3;
    out.width = 6e-3;
    const double d = std::max(0.0, X_JP.translation().z());
    if (d <= 0) {
      out.curve.stiffness = prior * stiffness_;
      return out;
    }
    PressAtRest press;
    press.X_JP = Pose(Eigen::Translation3d(X_JP.translation()));
    press.force.z() = -force(d);
    press.stiffness = stiffness_ * std::exp(kHardening * d);
    out.curve = fit_curve(out, press, {prior * stiffness_, kHardening, 0, 0});
    return out;
  }
  [[nodiscard]] double force(double d) const {
    return d > 0 ? stiffness_ / kHardening * std::expm1(kHardening * d) : 0;
  }

 private:
  static constexpr double kHardening = 200;
  double stiffness_;
};

}  // namespace

const char* to_string(ProbeGesture gesture) noexcept {
  constexpr std::array<const char*, 5> kNames{"press", "tap", "slide", "lift", "twist"};
  return kNames[static_cast<std::size_t>(gesture)];
}

Pose wanted_pose(ProbeGesture gesture, double t) {
  Pose pose = Pose::Identity();
  const double down = std::clamp((t - kHover) / 0.08, 0.0, 1.0);  // 0.14 m/s
  double z = -kStart + (kStart + kPressDepth) * down;
  if (gesture == ProbeGesture::tap && t > kHover) z = -1e-3 + 4e-3 * std::sin(kTurn * 4 * t);
  if (gesture == ProbeGesture::slide) pose.translation().x() = 10e-3 * std::sin(kTurn * 1.5 * t);
  if (gesture == ProbeGesture::lift && t > 1.5) z = std::max(-30e-3, z - 0.3 * (t - 1.5));
  if (gesture == ProbeGesture::twist)
    pose.rotate(Eigen::AngleAxisd(0.08 * std::sin(kTurn * 2 * t), Vec3::UnitY()));
  pose.translation().z() = z;
  return pose;
}

namespace {

/// The tissue's answers on their way to the tick.
class LateAnswers {
 public:
  LateAnswers(const ProbeHandCase& c, const ExponentialTissue& tissue)
      : case_(c), tissue_(tissue), ticks_(static_cast<std::uint64_t>(c.delay * c.tick_rate)) {}

  void pass(double t, std::uint64_t tick, const Pose& X_JP, SkinContact& contact) {
    if (t * case_.image_rate >= static_cast<double>(images_)) {
      ++images_;
      const bool lost = case_.lost && t > kHover + 0.2 && t < kHover + 0.7;
      if (!lost)
        answers_.push_back({tick + ticks_, tissue_.packet(X_JP, case_.prior, images_, tick)});
    }
    for (; !answers_.empty() && answers_.front().due <= tick; answers_.pop_front())
      contact.take(answers_.front().packet);
  }

 private:
  struct Answer {
    std::uint64_t due = 0;
    ProbePacket packet;
  };
  const ProbeHandCase& case_;
  const ExponentialTissue& tissue_;
  std::uint64_t ticks_;
  std::uint64_t images_ = 0;
  std::deque<Answer> answers_;
};

/// Contact, account and the guard's slew: what a session's tick does with a probe.
class ProbeTick {
 public:
  explicit ProbeTick(double rate)
      : contact(params_of(rate)),
        account_(kProbePassivity, 1 / rate, kProbeDampingForce),
        dt_(1 / rate) {}

  const Wrench& step(const Pose& X_JP, std::uint64_t tick) {
    Wrench wanted = contact.step(X_JP, tick);
    wanted.force = account_.step(X_JP.translation(), wanted.force);
    if (contact.share() == 0) wanted = {};
    const double change = (wanted.force - sent_.force).norm();
    if (change > kForceSlew * dt_)
      wanted.force = sent_.force + kForceSlew * dt_ / change * (wanted.force - sent_.force);
    account_.observe(wanted.force);
    sent_ = wanted;
    return sent_;
  }
  SkinContact contact;

 private:
  static SkinContactParams params_of(double rate) {
    SkinContactParams params;
    params.tick_rate = rate;
    return params;
  }
  PassivityObserver account_;
  double dt_;
  Wrench sent_;
};

/// What is seen of a hand's course, tick by tick.
class ProbeWatch {
 public:
  explicit ProbeWatch(const ProbeHandCase& c) : case_(c) {}

  /// `z`: m of the face's deepest point below the skin; `force`: N, commanded.
  void see(double t, double z, double force, const Vec3& velocity) {
    if (z < -0.2e-3) out.off_skin = std::max(out.off_skin, force);
    if (z > 0 && !met_) met_ = t;
    if (met_ && !touched_ && force > 1e-3) {
      touched_ = true;
      out.first_depth = z;
      if (velocity.z() > 0.1) out.first_touch = t - *met_;
    }
    if (touched_ && case_.gesture == ProbeGesture::press) out.highest = std::max(out.highest, -z);
    see_step(z, force, velocity);
    if (t > kSeconds - 0.6) (t > kSeconds - 0.3 ? late_ : early_).add(z);
  }
  void end(double truth) {
    if (case_.gesture != ProbeGesture::press) return;
    out.swing = late_.size() < 0.98 * early_.size() ? 0 : late_.size();
    if (truth > 0.1) out.settled = std::abs(force_ - truth) / truth;
  }
  ProbeHandResult out;

 private:
  /// Motion's own share: the steepest the tissue is here, with both arms.
  void see_step(double z, double force, const Vec3& velocity) {
    const SkinContactParams law;
    const double moved =
        std::max(std::abs(z - z_), (velocity.norm() + kFastestTurn) / case_.tick_rate);
    const double steepest = (1 + law.slow + law.fast) * 1.5 * (150 * case_.hardness + 200 * force);
    out.step = std::max(out.step, std::abs(force - force_) - steepest * moved);
    force_ = force;
    z_ = z;
  }

  const ProbeHandCase& case_;
  std::optional<double> met_;
  bool touched_ = false;
  Range early_;
  Range late_;
  double force_ = 0;
  double z_ = -kStart;
};

}  // namespace

ProbeHandResult play_probe_hand(const ProbeHandCase& c) {
  const double dt = 1 / c.tick_rate;
  const ExponentialTissue tissue(c.hardness);
  LateAnswers answers(c, tissue);
  ProbeTick loop(c.tick_rate);
  ProbeWatch watch(c);
  Pose start = Pose::Identity();
  start.translation().z() = -kStart;
  PushedProbe probe(c.hand, dt, start);
  Wrench commanded;
  const auto n = static_cast<std::uint64_t>(kSeconds * c.tick_rate);
  for (std::uint64_t tick = 1; tick <= n; ++tick) {
    const double t = static_cast<double>(tick) * dt;
    const Pose X_JP = probe.measured();
    answers.pass(t, tick, X_JP, loop.contact);
    const Wrench applied = commanded;  // a tick later
    commanded = loop.step(X_JP, tick);
    const double deepest = X_JP.translation().z() + 0.5 * 40e-3 * std::abs(X_JP.linear()(2, 0));
    watch.see(t, deepest, commanded.force.norm(), probe.velocity());
    if (c.hand.stiffness == 0) probe.push(t < kHover ? 0 : 3);
    probe.advance(applied, wanted_pose(c.gesture, t));
    watch.out.given = std::max(watch.out.given, probe.given());
  }
  watch.end(tissue.force(probe.pose().translation().z()));
  return watch.out;
}

std::vector<ProbeHandCase> probe_hand_cases(std::size_t every) {
  std::vector<ProbeHandCase> all;
  std::size_t n = 0;
  for (const double rate : {1e3, 1e4})
    for (const double mass : {0.05, 0.1, 0.3, 1.0})
      for (const double stiffness : {0.0, 300.0, 1000.0, 2000.0})
        for (const double damping : {0.0, 1.0, 3.0, 5.0, 10.0, 30.0})
          for (const double images : {5.0, 15.0, 30.0, 60.0})
            for (const ProbeGesture gesture :
                 {ProbeGesture::press, ProbeGesture::tap, ProbeGesture::slide, ProbeGesture::lift,
                  ProbeGesture::twist})
              for (const double prior : {0.7, 1.0, 1.3}) {
                if (damping < 3 && rate < 1e4) continue;
                if (n++ % every != 0) continue;
                ProbeHandCase c;
                c.hand = {mass, stiffness, damping, 0, n % 2 == 0 ? 0.03e-3 : 0.06e-3};
                c.gesture = gesture;
                c.tick_rate = rate;
                c.image_rate = images;
                c.delay = n % 3 == 0 ? 0.025 : n % 3 == 1 ? 0.06 : 0.18;
                c.lost = n % 4 == 0;
                c.prior = prior;
                all.push_back(c);
              }
  return all;
}

}  // namespace artus
