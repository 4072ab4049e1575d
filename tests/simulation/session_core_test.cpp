// SPDX-License-Identifier: AGPL-3.0-or-later
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "artus/detail/core/noise.h"
#include "artus/detail/core/units.h"
#include "artus/detail/haptics/probe/probe_contact.h"
#include "artus/detail/simulation/haptic_core.h"
#include "artus/session/shared_memory_device.h"
#include "tests/session/session_support.h"
#include "tests/support/no_alloc.h"
#include "tests/support/probe_press.h"

namespace artus {
namespace {

class SessionCore : public ::testing::Test {
 protected:
  std::shared_ptr<const Scene> scene_ = test::make_layered_scene();
  SessionParams params_ = test::make_small_session();
  HapticCore core_{scene_, params_};
  std::uint64_t tick_ = 0;

  const HapticSnapshot& step(double z, PeerState state = PeerState::alive,
                             std::uint32_t command = 0) {
    TickInput input;
    input.tick = ++tick_;
    input.device = test::sample_at(z, static_cast<std::int64_t>(tick_) * test::kTickTime, tick_);
    input.device.state = state;
    input.command = command;
    return core_.step(input);
  }
  /// Pushes in from 10 mm above the skin at 20 mm/s.
  const HapticSnapshot& insert_to(double depth) {
    double z = -10e-3;
    for (; z < depth; z += 20e-6) step(z);
    return step(depth);
  }
};

double force_norm(const DeviceFeedback& feedback) {
  return Vec3(feedback.force[0], feedback.force[1], feedback.force[2]).norm();
}

TEST_F(SessionCore, ANeedleInMuscleFeelsForceAgainstInsertion) {
  const HapticSnapshot& out = insert_to(15e-3);
  EXPECT_EQ(out.inserted, 1U);
  EXPECT_EQ(scene_->joint().regions[out.feedback.region].name, "muscle");
  EXPECT_LT(out.feedback.force[2], -0.5);
  EXPECT_NEAR(out.feedback.depth, 15e-3, 1e-6);
}

TEST_F(SessionCore, ForcesAreTurnedIntoTheWorldWithTheJoint) {
  const double along_z = insert_to(15e-3).feedback.force[2];
  SessionParams turned = params_;
  turned.X_WJ.linear() = Eigen::AngleAxisd(90 * kDegree, Vec3::UnitY()).toRotationMatrix();
  HapticCore core(scene_, turned);
  HapticSnapshot out;
  std::uint64_t n = 0;
  for (double z = -10e-3; z < 15e-3 + 20e-6; z += 20e-6) {
    TickInput input;
    ++n;
    input.device = test::sample_at(0, static_cast<std::int64_t>(n) * test::kTickTime, n);
    input.device.X_WN = to_plain(make_pose(Vec3(z, 0, 0), Vec3::UnitX(), Vec3::UnitY()));
    input.tick = n;
    out = core.step(input);
  }
  EXPECT_NEAR(out.feedback.force[0], along_z, 0.05);
  EXPECT_NEAR(out.feedback.force[2], 0, 1e-6);
}

TEST_F(SessionCore, ALostDeviceGetsNoForceAtOnce) {
  ASSERT_GT(force_norm(insert_to(15e-3).feedback), 0.5);
  const HapticSnapshot& out = step(15e-3, PeerState::lost);
  EXPECT_EQ(force_norm(out.feedback), 0);
  EXPECT_EQ(out.status, SessionStatus::kPeerLost);
}

TEST_F(SessionCore, APauseGivesNoForceAndForceComesBackSlowly) {
  ASSERT_GT(force_norm(insert_to(15e-3).feedback), 0.5);
  EXPECT_EQ(force_norm(step(15e-3, PeerState::alive, SessionCommand::kPause).feedback), 0);
  EXPECT_LT(force_norm(step(15e-3).feedback), 0.1);
}

TEST_F(SessionCore, AResetForgetsTheInsertion) {
  ASSERT_EQ(insert_to(15e-3).inserted, 1U);
  const HapticSnapshot& out = step(-10e-3, PeerState::alive, SessionCommand::kReset);
  EXPECT_EQ(force_norm(out.feedback), 0);
  EXPECT_EQ(step(-10e-3).inserted, 0U);
}

/// The probe's hand in the world's frame feels what the contact says in the joint's.
TEST_F(SessionCore, BetweenTheTissuesUpdatesTheProbeFeelsTheContactOfItsTick) {
  const Pose pressed = to_pose(test::sample_at(0, 0, 0).X_WP);
  const ProbePacket packet = test::pressing_packet(pressed, 5);
  core_.take({packet, {}});
  SkinContact alone(SkinContactParams{.friction = ProbeContactParams{}.gel_friction});
  alone.take(packet);
  constexpr double kDamped = 0.01;  // N, of the account while the force ramps up
  const Vec3 axis = Vec3(1, -2, 0.5).normalized();
  for (int i = 0; i <= 500; ++i) {
    const Vec3 course(1e-6 * i, -2e-6 * i, 1e-6 * i);
    const Pose now = pressed * Eigen::Translation3d(course) * Eigen::AngleAxisd(5e-5 * i, axis);
    TickInput input;
    input.tick = ++tick_;
    input.device =
        test::sample_at(-10e-3, static_cast<std::int64_t>(tick_) * test::kTickTime, tick_);
    input.device.X_WP = to_plain(now);
    const DeviceFeedback& felt = core_.step(input).feedback;
    const Wrench expected = alone.step(now, tick_);
    if (i < 300) continue;  // the ramp after the start
    for (std::size_t k = 0; k < 3; ++k) {
      ASSERT_NEAR(felt.probe_force[k], expected.force[static_cast<Eigen::Index>(k)], kDamped) << i;
      ASSERT_NEAR(felt.probe_torque[k], expected.torque[static_cast<Eigen::Index>(k)], 1e-9) << i;
    }
    EXPECT_NEAR(felt.tissue_age, 1e-3 * static_cast<double>(tick_), 1e-9);
    EXPECT_TRUE((felt.status & SessionStatus::kTissueLate) != 0) << "older than 0.1 s";
  }
}

TEST_F(SessionCore, TheProbesForceSaysWhenItIsHeldBack) {
  const Pose pressed = to_pose(test::sample_at(0, 0, 0).X_WP);
  core_.take({test::pressing_packet(pressed, 9), {}});
  const auto felt = [this](PeerState state = PeerState::alive) {
    const DeviceFeedback& out = step(-10e-3, state).feedback;
    return std::pair(Vec3(out.probe_force[0], out.probe_force[1], out.probe_force[2]).norm(),
                     out.probe_status);
  };
  for (int i = 0; i < 3000; ++i) step(-10e-3);
  EXPECT_NEAR(felt().first, 9, 0.05);
  EXPECT_EQ(felt().second, TickStatus::kOk);
  EXPECT_EQ(felt(PeerState::lost), std::pair(0.0, TickStatus::kStale));
  const auto back = felt();
  EXPECT_LT(back.first, 1);
  EXPECT_EQ(back.second, TickStatus::kRamping);
  EXPECT_EQ(felt(PeerState::lost).first, 0);
  core_.take({test::pressing_packet(pressed, 60, 3e-3, 2), {}});  // more than a hand is given
  for (int i = 0; i < 4000; ++i) step(-10e-3);
  EXPECT_NEAR(felt().first, params_.device.probe_force, 1e-9);
  EXPECT_EQ(felt().second, TickStatus::kSaturated);
}

TEST_F(SessionCore, NoInputOfAPeerGivesAForceThatIsNotFiniteOrOverTheLimit) {
  const double limit = params_.device.force;
  artus_shm_pos pos{};
  PosReader reader;
  auto* bytes = reinterpret_cast<unsigned char*>(&pos);
  for (std::uint64_t i = 1; i < 20000; ++i) {
    const std::int64_t now = static_cast<std::int64_t>(i) * test::kTickTime;
    if (i % 3 != 0) {  // garbage: all bytes, or one word of a good sample
      pos = artus_shm_pos_init();
      for (std::size_t b = 0; b < sizeof pos; ++b) {
        if (i % 3 == 1 || b / 8 == i % (sizeof pos / 8))
          bytes[b] = static_cast<unsigned char>(mix_bits(i * 1000 + b));
      }
      if (i % 2 == 0) pos.time_ns = static_cast<std::uint64_t>(now);
      if (i % 7 == 0) pos.needle_position[1] = std::numeric_limits<double>::quiet_NaN();
      pos.present = i % 5 == 0 ? pos.present : 3;
    } else {
      pos.sample = i;
      pos.time_ns = static_cast<std::uint64_t>(now);
      pos.needle_position[0] = pos.needle_position[1] = 0;
      pos.needle_position[2] = 10e-3;
    }
    TickInput input;
    input.tick = i;
    input.device = reader.accept(true, pos, now);
    const HapticSnapshot& out = core_.step(input);
    for (const double f : out.feedback.force) ASSERT_TRUE(std::isfinite(f));
    for (const double t : out.feedback.torque) ASSERT_TRUE(std::isfinite(t));
    ASSERT_LE(force_norm(out.feedback), limit * (1 + 1e-12));
  }
}

TEST_F(SessionCore, TicksDoNotAllocate) {
  if (!test::AllocationCounter::supported()) GTEST_SKIP() << "no allocation counter in this build";
  step(-10e-3);
  const test::AllocationCounter counter;
  insert_to(20e-3);
  EXPECT_EQ(counter.count(), 0);
}

TEST_F(SessionCore, TheChosenEntryPointMeetsTheDevicesInsertionPoint) {
  GestureParams gesture;
  gesture.p_W = Vec3(0.1, 0.2, 0.05);
  gesture.axis_W = Vec3(0, 0.6, 0.8);
  const Pose X_JP = make_pose(Vec3(0.02, 0.01, 0), Vec3::UnitZ(), Vec3::UnitX());
  const auto choice = choose_entry(*scene_, X_JP, gesture);
  ASSERT_TRUE(choice);
  EXPECT_NEAR(choice->p_J.z(), 0, 1e-7);
  const Pose X_WJ = calibrate_joint(Pose::Identity(), *choice, gesture);
  EXPECT_NEAR((X_WJ * choice->p_J - gesture.p_W).norm(), 0, 1e-12);
  EXPECT_NEAR((X_WJ.linear() * choice->direction_J - gesture.axis_W).norm(), 0, 1e-12);
}

TEST_F(SessionCore, AButtonCalibratesOnceAndAnotherGoesBack) {
  TwoPhaseGesture gesture(GestureParams{}, Pose::Identity());
  const Pose X_WP = make_pose(Vec3(0.02, 0.01, 0), Vec3::UnitZ(), Vec3::UnitX());
  EXPECT_TRUE(gesture.step(*scene_, Button::kCalibrate, X_WP));
  EXPECT_EQ(gesture.phase(), GesturePhase::inserting);
  EXPECT_FALSE(gesture.step(*scene_, Button::kCalibrate, X_WP));
  EXPECT_TRUE(gesture.step(*scene_, Button::kExplore, X_WP));
  EXPECT_EQ(gesture.phase(), GesturePhase::exploring);
  EXPECT_TRUE(gesture.X_WJ().isApprox(Pose::Identity()));
}

TEST_F(SessionCore, NoEntryIsChosenWhileTheNeedleIsIn) {
  const PlainPose before = insert_to(10e-3).X_WJ;
  TickInput input;
  input.tick = ++tick_;
  input.device = test::sample_at(10e-3, static_cast<std::int64_t>(tick_) * test::kTickTime, tick_);
  input.device.buttons = Button::kCalibrate;
  const HapticSnapshot& out = core_.step(input);
  ASSERT_EQ(out.inserted, 1U);
  EXPECT_EQ(out.phase, GesturePhase::exploring);
  EXPECT_TRUE(to_pose(out.X_WJ).isApprox(to_pose(before), 0));
}

TEST(PosReader, WhatWasThereBeforeIsNotAlive) {
  PosReader reader;
  artus_shm_pos pos = artus_shm_pos_init();
  pos.sample = 77;
  EXPECT_EQ(reader.accept(true, pos, 5 * test::kTickTime).state, PeerState::absent);
}

TEST(PosReader, ASilentPeerIsLostBeforeTwentyMilliseconds) {
  PosReader reader;
  artus_shm_pos pos = artus_shm_pos_init();
  pos.sample = 0;
  EXPECT_EQ(reader.accept(true, pos, 0).state, PeerState::absent);
  pos.sample = 1;
  pos.time_ns = test::kTickTime;
  EXPECT_EQ(reader.accept(true, pos, test::kTickTime).state, PeerState::alive);
  EXPECT_EQ(reader.accept(true, pos, 15 * test::kTickTime).state, PeerState::alive);
  EXPECT_EQ(reader.accept(false, pos, 17 * test::kTickTime).state, PeerState::lost);
}

TEST(PosReader, AClockFromAnotherTimeIsInvalid) {
  PosReader reader;
  artus_shm_pos pos = artus_shm_pos_init();
  EXPECT_EQ(reader.accept(true, pos, 0).state, PeerState::absent);
  pos.sample = 1;
  pos.time_ns = 100'000'000'000;
  EXPECT_EQ(reader.accept(true, pos, test::kTickTime).state, PeerState::invalid);
}

TEST(SessionParams, TheNeedleHasOneLengthForTheHandAndForThePicture) {
  SessionParams params;
  EXPECT_EQ(NeedleShape{}.length, ContactParams{}.needle_length);
  EXPECT_EQ(NeedleTick{}.needle_length, ContactParams{}.needle_length);
  EXPECT_EQ(needle_length_of(params), ContactParams{}.needle_length);
  params.feel.needle_length = 0.05;
  EXPECT_EQ(needle_length_of(params), 0.05);
}

/// A reader that has heard sample 1000 of writer 1 at 10 ms.
class HeardReader : public ::testing::Test {
 protected:
  HeardReader() {
    hear(999, 9);
    hear(1000, 10);
  }
  DeviceSample hear(std::uint64_t number, std::int64_t ms, std::uint64_t writer = 1) {
    artus_shm_pos pos = artus_shm_pos_init();
    pos.sample = number;
    pos.time_ns = static_cast<std::uint64_t>(ms * test::kTickTime);
    return reader_.accept(true, pos, ms * test::kTickTime, writer);
  }
  PosReader reader_;
};

TEST_F(HeardReader, ASampleThatGoesBackwardIsRefused) {
  EXPECT_EQ(hear(500, 11).state, PeerState::invalid);
  EXPECT_EQ(hear(501, 12).state, PeerState::invalid) << "also those after it";
  EXPECT_EQ(hear(501, 12).number, 1000U);
  EXPECT_EQ(hear(1001, 13).state, PeerState::alive);
  for (std::int64_t ms = 14; ms < 60; ++ms) hear(700, ms);
  EXPECT_NE(hear(700, 60).state, PeerState::alive) << "no refused sample keeps it alive";
}

TEST_F(HeardReader, AnotherWriterMayCountFromOne) {
  EXPECT_EQ(hear(1000, 11, 2).number, 1000U) << "what it found is no sample of its own";
  EXPECT_EQ(hear(1, 12, 2).state, PeerState::alive);
  EXPECT_EQ(hear(2, 13, 2).number, 2U);
}

TEST_F(HeardReader, AfterSilenceTheCountMayBeginAgain) {
  EXPECT_EQ(hear(1000, 24).state, PeerState::alive);
  EXPECT_EQ(hear(1, 26).state, PeerState::alive);
}

TEST_F(HeardReader, GarbageDoesNotRaiseTheCount) {
  artus_shm_pos pos = artus_shm_pos_init();
  pos.sample = ~std::uint64_t{0};
  pos.time_ns = 11 * test::kTickTime;
  pos.present = 0xff;
  EXPECT_EQ(reader_.accept(true, pos, 11 * test::kTickTime, 1).state, PeerState::invalid);
  EXPECT_EQ(hear(1001, 12).state, PeerState::alive);
}

}  // namespace
}  // namespace artus
