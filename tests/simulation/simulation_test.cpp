// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/simulation/simulation.h"

#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "tests/session/session_support.h"
#include "tests/support/meshed_block.h"

namespace artus {
namespace {

constexpr double kPeriod = 1e-3;  // s

CompiledJoint make_block() {
  const std::array<FlatLayer, 4> layers{
      {{"skin", 2e-3}, {"fat", 8e-3}, {"muscle", 20e-3}, {"bone", 10e-3}}};
  return test::make_meshed_block(layers, 0.096, 0.064, 4e-3);
}

std::shared_ptr<const Scene> block() {
  return std::make_shared<const Scene>(std::make_shared<const CompiledJoint>(make_block()));
}

SessionParams soft_params() {
  SessionParams params = test::make_small_session();
  params.deform = true;
  return params;
}

/// Down through the skin and on, the probe pressed by 1 mm, the plunger pushed from half a second
/// on.
TickInput input_of(const Scene& scene, std::uint64_t tick) {
  const double t = kPeriod * static_cast<double>(tick);
  TickInput input;
  input.tick = tick;
  input.device = test::sample_at(0, static_cast<std::int64_t>(tick) * test::kTickTime, tick);
  Pose X = scene.joint().X_JP_default;
  input.device.X_WP = to_plain(X * Eigen::Translation3d(0, 0, std::min(1e-3, 5e-3 * t)));
  input.device.X_WN = to_plain(X * Eigen::Translation3d(4e-3, 11e-3, -3e-3 + 15e-3 * t));
  if (t > 0.5) {
    input.device.plunger = PlungerSign::force;
    input.device.plunger_force = 12;
  }
  return input;
}

bool same_force(const HapticSnapshot& a, const HapticSnapshot& b) {
  return std::equal(std::begin(a.force_J), std::end(a.force_J), std::begin(b.force_J)) &&
         std::equal(std::begin(a.feedback.probe_force), std::end(a.feedback.probe_force),
                    std::begin(b.feedback.probe_force));
}

TEST(Simulation, ALoopGivesTheBytesOfItsHalvesWhetherSomebodyLooksOrNot) {
  const auto scene = block();
  Simulation loop(scene, soft_params());
  Simulation blind(scene, soft_params());  // its pictures are never asked for
  Simulation halves(scene, soft_params());
  std::uint64_t images = 0;
  double felt = 0;
  for (std::uint64_t tick = 1; tick <= 900; ++tick) {
    const TickInput input = input_of(*scene, tick);
    const HapticSnapshot& a = loop.step(input);
    const HapticSnapshot& b = blind.step(input);
    const HapticSnapshot& c = halves.tick(input);
    ASSERT_TRUE(same_force(a, b)) << tick;
    ASSERT_TRUE(same_force(a, c)) << tick;
    felt = std::max(felt, std::abs(a.force_J[2]));
    ASSERT_EQ(loop.due() != nullptr, blind.due() != nullptr);
    if (loop.due() == nullptr) continue;
    const FrameInput due = frame_input(c, controls_of(soft_params()), ++images);
    EXPECT_EQ(loop.due()->number, images);
    const ImagedBody body = halves.advance(due);
    halves.take(body.packet.value());
    const std::uint64_t drawn = digest_of(loop.render());
    EXPECT_EQ(drawn, digest_of(halves.render(due, body)));
  }
  EXPECT_EQ(images, 27U);  // 30 a second, the first at once
  EXPECT_GT(felt, 0.5);
}

TEST(Simulation, WhatTheTissueAnswersIsFeltFromTheTickAfterItsImageOn) {
  const auto scene = block();
  Simulation simulation(scene, soft_params());
  std::uint64_t answered = 0;  // tick of the pose that the newest answer is of
  bool pressed = false;
  for (std::uint64_t tick = 1; tick <= 300; ++tick) {
    const DeviceFeedback& felt = simulation.step(input_of(*scene, tick)).feedback;
    const double age = answered > 0 ? 1e-3 * static_cast<double>(tick - answered) : 0;
    EXPECT_NEAR(felt.tissue_age, age, 1e-12) << tick;
    pressed = pressed || felt.probe_share > 0;
    EXPECT_FALSE(pressed && answered == 0) << "nothing is felt of a body that said nothing";
    if (simulation.due() == nullptr) continue;
    answered = simulation.due()->tick;
    EXPECT_EQ(answered, tick);
    EXPECT_EQ(simulation.advance().packet->probe.tick, tick);
  }
  EXPECT_TRUE(pressed);
}

TEST(Simulation, NothingPassesTheGuardNeitherTheThumbNorAnAid) {
  const auto scene = test::make_layered_scene();
  SessionParams params = test::make_small_session();
  params.syringe.unbalanced = 1;  // all of the thumb's force goes to the needle
  params.guard.force_slew = 200;
  params.aids.entry = Vec3(2e-3, 0, 0);
  params.aids.target = Vec3(2e-3, 0, 20e-3);
  params.aids.guide = 1000;
  Simulation simulation(scene, params);
  Vec3 before = Vec3::Zero();
  double most = 0;
  double pushed = 0;
  for (std::uint64_t tick = 1; tick <= 2500; ++tick) {
    TickInput input;
    input.tick = tick;
    const double z = std::min(12e-3, -5e-3 + 15e-6 * static_cast<double>(tick));
    input.device = test::sample_at(z, static_cast<std::int64_t>(tick) * test::kTickTime, tick);
    if (tick > 1800) {
      input.device.plunger = PlungerSign::force;
      input.device.plunger_force = tick % 100 < 50 ? 40 : 0;
    }
    const HapticSnapshot& out = simulation.step(input);
    const Vec3 force(out.force_J[0], out.force_J[1], out.force_J[2]);
    EXPECT_LE(force.norm(), params.device.force * (1 + 1e-9)) << tick;
    EXPECT_LE((force - before).norm(), params.guard.force_slew * kPeriod * (1 + 1e-9)) << tick;
    before = force;
    most = std::max(most, force.norm());
    if (tick > 1800) pushed = std::max(pushed, force.z());
  }
  EXPECT_GT(pushed, 2);  // the thumb is felt
  EXPECT_GT(most, 2);
}

TEST(Simulation, TheEnergyAccountCountsWhatTheThumbAddsToTheNeedle) {
  const auto scene = test::make_layered_scene();
  SessionParams params = test::make_small_session();
  params.syringe.unbalanced = 1;
  Simulation simulation(scene, params);
  double energy = 0;
  Vec3 sent = Vec3::Zero();
  Vec3 before = Vec3::Zero();
  for (std::uint64_t tick = 1; tick <= 2000; ++tick) {
    TickInput input;
    input.tick = tick;
    const double z = -5e-3 + 10e-6 * static_cast<double>(tick);
    input.device = test::sample_at(z, static_cast<std::int64_t>(tick) * test::kTickTime, tick);
    input.device.plunger = PlungerSign::force;
    input.device.plunger_force = tick > 1000 ? 10 : 0;
    const HapticSnapshot& out = simulation.step(input);
    const Vec3 tip(out.X_JN.position[0], out.X_JN.position[1], out.X_JN.position[2]);
    if (tick > 1) energy += sent.dot(tip - before);
    before = tip;
    sent = Vec3(out.force_J[0], out.force_J[1], out.force_J[2]);
  }
  EXPECT_NEAR(simulation.energy_to_hand(), energy, 1e-9);
}

TEST(Simulation, IsALoopOfTenLinesOverACompiledJoint) {
  SimulationOptions options;
  options.device = "touch";
  Simulation simulation(make_block(), options);
  const Pose X_JP = simulation.joint().X_JP_default;
  double most = 0;
  int pictures = 0;
  for (int tick = 0; tick < 1200; ++tick) {
    Hands hands;
    hands.X_WP = X_JP * Eigen::Translation3d(0, 0, 1e-3);
    hands.X_WN = X_JP * Eigen::Translation3d(4e-3, 11e-3, -3e-3 + 1e-5 * tick);
    const Felt& felt = simulation.step(hands);
    most = std::max(most, felt.force.norm());
    if (!felt.image_due || tick < 1150) continue;
    EXPECT_GT(simulation.render().width, 100);
    ++pictures;
  }
  EXPECT_GT(most, 0.3);
  EXPECT_EQ(pictures, 1);
  EXPECT_NEAR(simulation.time(), 1.2, 1e-12);
  EXPECT_TRUE(simulation.refusal().empty());
  EXPECT_NE(simulation.scene(), simulation.rest_scene());
  options.device = "hammer";
  EXPECT_ANY_THROW(Simulation(make_block(), options));
}

}  // namespace
}  // namespace artus
