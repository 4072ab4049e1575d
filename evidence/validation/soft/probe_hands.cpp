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

ProbeHandResult play_probe_hand(const ProbeHandCase& c) {
  const double dt = 1 / c.tick_rate;
  const ExponentialTissue tissue(c.hardness);
  SkinContactParams law;
  law.tick_rate = c.tick_rate;
  SkinContact contact(law);
  PassivityObserver account(kProbePassivity, dt, kProbeDampingForce);
  Pose start = Pose::Identity();
  start.translation().z() = -kStart;
  PushedProbeParams params = c.hand;
  PushedProbe probe(params, dt, start);
  ProbeHandResult out;
  struct Answer {
    std::uint64_t due = 0;
    ProbePacket packet;
  };
  std::deque<Answer> answers;
  Wrench commanded;
  Wrench applied;  // a tick later
  std::optional<double> met;
  bool touched = false;
  Range early;
  Range late;
  std::uint64_t images = 0;
  double force_before = 0;
  double z_before = start.translation().z();
  const auto n = static_cast<std::uint64_t>(kSeconds * c.tick_rate);
  for (std::uint64_t tick = 1; tick <= n; ++tick) {
    const double t = static_cast<double>(tick) * dt;
    const Pose X_JP = probe.measured();
    // Of the face's deepest point.
    const double z = X_JP.translation().z() + 0.5 * 40e-3 * std::abs(X_JP.linear()(2, 0));
    if (t * c.image_rate >= static_cast<double>(images)) {
      ++images;
      const bool lost = c.lost && t > kHover + 0.2 && t < kHover + 0.7;
      const auto ticks = static_cast<std::uint64_t>(c.delay * c.tick_rate);
      if (!lost) answers.push_back({tick + ticks, tissue.packet(X_JP, c.prior, images, tick)});
    }
    for (; !answers.empty() && answers.front().due <= tick; answers.pop_front())
      contact.take(answers.front().packet);
    Wrench wanted = contact.step(X_JP, tick);
    wanted.force = account.step(X_JP.translation(), wanted.force);
    if (contact.share() == 0) wanted = {};
    const double change = (wanted.force - commanded.force).norm();
    if (change > kForceSlew * dt)
      wanted.force = commanded.force + kForceSlew * dt / change * (wanted.force - commanded.force);
    account.observe(wanted.force);
    const double force = wanted.force.norm();
    if (z < -0.2e-3) out.off_skin = std::max(out.off_skin, force);
    if (z > 0 && !met) met = t;
    if (met && !touched && force > 1e-3) {
      touched = true;
      out.first_depth = z;
      if (probe.velocity().z() > 0.1) out.first_touch = t - *met;
    }
    if (touched && c.gesture == ProbeGesture::press) out.highest = std::max(out.highest, -z);
    // Motion's own share: the steepest the tissue is here, with both arms.
    const double steepest = (1 + law.slow + law.fast) * 1.5 * (150 * c.hardness + 200 * force);
    const double beyond =
        std::abs(force - force_before) -
        steepest * std::max(std::abs(z - z_before), dt * (probe.velocity().norm() + kFastestTurn));
    out.step = std::max(out.step, beyond);
    force_before = force;
    z_before = z;
    if (t > kSeconds - 0.6) (t > kSeconds - 0.3 ? late : early).add(z);
    applied = commanded;
    commanded = wanted;
    if (params.stiffness == 0) probe.push(t < kHover ? 0 : 3);
    probe.advance(applied, wanted_pose(c.gesture, t));
    out.given = std::max(out.given, probe.given());
  }
  if (c.gesture == ProbeGesture::press) {
    out.swing = late.size() < 0.98 * early.size() ? 0 : late.size();
    const double truth = tissue.force(probe.pose().translation().z());
    if (truth > 0.1) out.settled = std::abs(force_before - truth) / truth;
  }
  return out;
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
