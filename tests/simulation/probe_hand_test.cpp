// SPDX-License-Identifier: AGPL-3.0-or-later
// Hands with a probe on tissue that gives way, whose answers come late or not at all.
#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <numbers>

#include <gtest/gtest.h>

#include "artus/detail/operators/pushed_probe.h"
#include "artus/simulation/simulation.h"
#include "tests/session/session_support.h"
#include "tests/support/meshed_block.h"

namespace artus {
namespace {

constexpr double kStart = 6e-3;  // m above the skin
constexpr double kHover = 0.3;   // s before the hand comes down
constexpr double kSeconds = 2;

struct Hand {
  const char* name;
  PushedProbeParams params;
  double push = 0;   // N from kHover on
  double depth = 0;  // m below the skin that its spring wants
  double tap = 0;    // Hz
  double slide = 0;  // m to each side
  double image_rate = 30;
  std::uint64_t late = 30;  // ticks from a pose to its answer
  bool lost = false;        // no answers from 0.6 to 1.1 s
};

const std::shared_ptr<const Scene>& block() {
  static const std::shared_ptr<const Scene> scene = [] {
    const std::array<FlatLayer, 4> layers{
        {{"skin", 2e-3}, {"fat", 8e-3}, {"muscle", 20e-3}, {"bone", 10e-3}}};
    return std::make_shared<const Scene>(
        std::make_shared<const CompiledJoint>(test::make_meshed_block(layers, 0.064, 0.048, 4e-3)));
  }();
  return scene;
}

Pose wanted(const Hand& hand, const Pose& skin, double t) {
  const double down = std::clamp((t - kHover) / 0.06, 0.0, 1.0);
  double z = -kStart + (kStart + hand.depth) * down;
  if (hand.tap > 0) z += 3e-3 * std::sin(2 * std::numbers::pi * hand.tap * t);
  Pose pose = skin;
  pose.translate(Vec3(hand.slide * std::sin(2 * std::numbers::pi * 1.5 * t), 0, z));
  return pose;
}

struct Course {
  double given = -INFINITY;       // J to the hand, the most at any time
  double off_skin = 0;            // N more than 0.2 mm off the skin
  double first_depth = INFINITY;  // m of the face at the first force
  double end_swing = 0;           // m in the last 0.2 s
  double end_force = 0;           // N
};

Course play(const Hand& hand) {
  SessionParams params = test::make_small_session();
  params.deform = true;
  params.image_rate = hand.image_rate;
  Simulation simulation(block(), params);
  const Pose skin = block()->joint().X_JP_default;
  Pose start = skin;
  start.translate(Vec3(0, 0, -kStart));
  PushedProbe probe(hand.params, 1e-3, start);
  struct Answer {
    std::uint64_t tick;
    TissuePacket packet;
  };
  std::deque<Answer> answers;
  Course course;
  Wrench commanded;
  double low = INFINITY;
  double high = -INFINITY;
  std::uint64_t images = 0;
  for (std::uint64_t tick = 1; tick <= static_cast<std::uint64_t>(1e3 * kSeconds); ++tick) {
    const double t = 1e-3 * static_cast<double>(tick);
    for (; !answers.empty() && answers.front().tick <= tick; answers.pop_front())
      simulation.take(answers.front().packet);
    TickInput input;
    input.tick = tick;
    input.device.number = tick;
    input.device.time_ns = static_cast<std::int64_t>(tick) * test::kTickTime;
    input.device.state = PeerState::alive;
    input.device.has_probe = 1;
    input.device.X_WP = to_plain(probe.measured());
    const HapticSnapshot& out = simulation.tick(input);
    if (t * hand.image_rate >= static_cast<double>(images)) {
      const ImagedBody body = simulation.advance(frame_input(out, controls_of(params), ++images));
      const bool lost = hand.lost && t > 0.6 && t < 1.1;
      if (!lost && body.packet) answers.push_back({tick + hand.late, *body.packet});
    }
    const double z = (skin.inverse() * probe.pose()).translation().z();
    const DeviceFeedback& felt = out.feedback;
    const Wrench applied = commanded;  // a tick later
    commanded.force = Vec3(felt.probe_force[0], felt.probe_force[1], felt.probe_force[2]);
    commanded.torque = Vec3(felt.probe_torque[0], felt.probe_torque[1], felt.probe_torque[2]);
    if (z < -0.2e-3) course.off_skin = std::max(course.off_skin, commanded.force.norm());
    if (commanded.force.norm() > 1e-3) course.first_depth = std::min(course.first_depth, z);
    if (t > kSeconds - 0.2) {
      low = std::min(low, z);
      high = std::max(high, z);
    }
    probe.push(t < kHover ? 0 : hand.push);
    probe.advance(applied, wanted(hand, skin, t));
    course.given = std::max(course.given, probe.given());
  }
  course.end_swing = high - low;
  course.end_force = commanded.force.norm();
  return course;
}

TEST(ProbeHand, IsStableOnTissueThatGivesWayHoweverLateItAnswers) {
  const std::array<Hand, 9> hands{{
      {"pushed with 3 N, 3 N s/m", {0.3, 0, 3, 0, 0}, 3, 0, 0, 0, 30, 30, false},
      {"pushed with 3 N, 10 N s/m, lost", {0.3, 0, 10, 0, 3e-5}, 3, 0, 0, 0, 30, 30, true},
      {"light, pushed with 2 N", {0.05, 0, 3, 0, 3e-5}, 2, 0, 0, 0, 30, 60, false},
      {"spring of 300 N/m", {0.3, 300, 5, 0, 0}, 0, 3e-3, 0, 0, 30, 30, false},
      {"spring of 2000 N/m, five answers a second",
       {0.1, 2000, 5, 0, 3e-5},
       0,
       2e-3,
       0,
       0,
       5,
       60,
       false},
      {"heavy on a spring, sixty answers", {1, 1000, 10, 0, 0}, 0, 3e-3, 0, 0, 60, 15, false},
      {"taps at 4 Hz, answers 184 ms late", {0.3, 2000, 10, 0, 3e-5}, 0, 0, 4, 0, 30, 184, false},
      {"presses at 1 Hz, answers 184 ms late",
       {0.3, 2000, 10, 0, 0},
       0,
       3e-3,
       1,
       0,
       30,
       184,
       false},
      {"slides", {0.3, 1000, 5, 0, 3e-5}, 0, 2e-3, 0, 4e-3, 30, 30, false},
  }};
  for (const Hand& hand : hands) {
    SCOPED_TRACE(hand.name);
    const Course course = play(hand);
    EXPECT_LE(course.given, 1e-6) << "J";
    EXPECT_EQ(course.off_skin, 0);
    EXPECT_LT(course.first_depth, 1e-3);
    if (hand.tap > 0 || hand.slide > 0) continue;
    EXPECT_LT(course.end_swing, 0.5e-3);
    if (hand.push > 0) {
      EXPECT_NEAR(course.end_force, hand.push, 0.05 * hand.push);
    }
  }
}

}  // namespace
}  // namespace artus
