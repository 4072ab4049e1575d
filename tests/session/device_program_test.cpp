// SPDX-License-Identifier: AGPL-3.0-or-later
// What device programs of a laboratory do that is no accident: they count anew, they are slow, they
// are two. The programs' side is the C client.
#include <cmath>
#include <limits>

#include <unistd.h>

#include <gtest/gtest.h>

#include "artus/detail/simulation/haptic_core.h"
#include "artus/session/shared_memory_device.h"
#include "tests/session/session_support.h"
#include "tests/support/probe_press.h"

namespace artus {
namespace {

constexpr std::int64_t kTickNs = 1'000'000;  // ns

artus_shm_pos pos_at(std::uint64_t sample, std::int64_t now_ns) {
  artus_shm_pos pos = artus_shm_pos_init();
  pos.sample = sample;
  pos.time_ns = static_cast<std::uint64_t>(now_ns);
  pos.present = ARTUS_SHM_NEEDLE;
  return pos;
}

/// A reader that was told `n` samples at 1 kHz, the first of them number `first`.
struct Told {
  PosReader reader;
  std::int64_t now = 1000 * kTickNs;

  DeviceSample say(artus_shm_pos pos) {
    now += kTickNs;
    pos.time_ns = static_cast<std::uint64_t>(now);
    return reader.accept(true, pos, now);
  }
  DeviceSample say(std::uint64_t first, int n) {
    DeviceSample last;
    for (int i = 0; i < n; ++i) last = say(pos_at(first + static_cast<std::uint64_t>(i), now));
    return last;
  }
};

TEST(PosReader, NumbersThatBeginAnewAreServedAfterFifteenMilliseconds) {
  Told told;
  ASSERT_EQ(told.say(3'600'000, 10).state, PeerState::alive);
  EXPECT_EQ(told.say(1, 5).state, PeerState::invalid) << "at first it may be an old sample";
  EXPECT_EQ(told.say(6, 20).state, PeerState::alive);
}

TEST(PosReader, OneFlippedBitDoesNotDeafenIt) {
  Told told;
  ASSERT_EQ(told.say(100, 10).state, PeerState::alive);
  EXPECT_EQ(told.say(std::uint64_t{1} << 62U, 1).state, PeerState::alive);
  EXPECT_EQ(told.say(111, 30).state, PeerState::alive);
}

TEST(PosReader, OldSamplesThatDoNotRiseAreNeverServed) {
  Told told;
  ASSERT_EQ(told.say(1000, 10).state, PeerState::alive);
  for (std::uint64_t n = 900; n > 850; --n) EXPECT_NE(told.say(n, 1).state, PeerState::alive);
}

TEST(PosReader, ASlowDeviceIsHeldForAsLongAsItAsksUpToATenthOfASecond) {
  for (const std::uint32_t hold : {0U, 70U}) {
    PosReader reader;
    std::int64_t now = 1000 * kTickNs;
    int alive = 0;
    for (int tick = 0; tick < 330; ++tick, now += kTickNs) {
      artus_shm_pos pos =
          pos_at(1 + static_cast<std::uint64_t>(tick / 33), now - tick % 33 * kTickNs);
      pos.hold_ms = hold;
      alive += reader.accept(true, pos, now).state == PeerState::alive ? 1 : 0;
    }
    EXPECT_EQ(alive > 290, hold != 0) << hold << ": " << alive;
  }
  Told told;
  artus_shm_pos endless = pos_at(1, 0);
  told.say(endless);
  endless.sample = 2;
  endless.hold_ms = 5000;
  EXPECT_EQ(told.say(endless).state, PeerState::invalid);
}

TEST(PosReader, TheProbesProgramSaysNothingOfTheNeedle) {
  PosReader reader(ARTUS_SHM_PROBE);
  std::int64_t now = 1000 * kTickNs;
  artus_shm_pos pos = pos_at(1, now);
  static_cast<void>(reader.accept(true, pos, now));
  pos.sample = 2;
  EXPECT_EQ(reader.accept(true, pos, now).state, PeerState::invalid);
  pos.sample = 3;
  pos.present = ARTUS_SHM_PROBE;
  EXPECT_EQ(reader.accept(true, pos, now).state, PeerState::alive);
}

TEST(JoinHands, TakesTheNeedleFromOneAndTheProbeFromTheOther) {
  DeviceSample needle = test::sample_at(5e-3, 1000, 7);
  DeviceSample probe = test::sample_at(0, 2000, 9);
  probe.has_needle = 0;
  probe.X_WP.position[0] = 0.04;
  const DeviceSample both = join_hands(needle, probe);
  EXPECT_EQ(both.state, PeerState::alive);
  EXPECT_EQ(both.number, 7U);
  EXPECT_EQ(both.has_needle, 1U);
  EXPECT_EQ(both.X_WP.position[0], 0.04);
  needle.state = PeerState::lost;
  const DeviceSample left = join_hands(needle, probe);
  EXPECT_EQ(left.state, PeerState::alive) << "the probe's picture goes on";
  EXPECT_EQ(left.has_needle, 0U);
  EXPECT_EQ(left.has_probe, 1U);
  probe.state = PeerState::lost;
  EXPECT_EQ(join_hands(needle, probe).state, PeerState::lost);
  probe.state = PeerState::absent;
  EXPECT_EQ(join_hands(needle, probe).number, 7U) << "one program alone is as it was";
}

/// Names of their own for each test, gone afterwards.
class DevicePrograms : public ::testing::Test {
 protected:
  ~DevicePrograms() override {
    for (const SegmentLayout& layout : kAllLayouts) SharedSegment::remove(prefix_, layout);
  }
  std::string prefix_ = "artus-programs-" + std::to_string(getpid()) + "-";
};

TEST_F(DevicePrograms, NeedleAndProbeMayBeTwoAndEachRoleHasOneWriter) {
  auto device = SharedMemoryDevice::open(prefix_, {});
  ASSERT_TRUE(device) << device.error().to_string();
  artus_shm_link needle{};
  artus_shm_link probe{};
  artus_shm_link third{};
  ASSERT_EQ(artus_shm_open(&needle, prefix_.c_str()), 0);
  ASSERT_EQ(artus_shm_open_role(&probe, prefix_.c_str(), ARTUS_SHM_ROLE_PROBE), 0);
  EXPECT_NE(artus_shm_open_role(&third, prefix_.c_str(), ARTUS_SHM_ROLE_PROBE), 0);
  EXPECT_EQ(errno, EBUSY);
  EXPECT_STREQ(third.refusal, "POS-PROBE");
  DeviceSample heard;
  for (std::uint64_t n = 1; n <= 3; ++n) {
    artus_shm_pos of_needle = artus_shm_pos_init();
    of_needle.sample = 100 + n;
    of_needle.present = ARTUS_SHM_NEEDLE;
    artus_shm_write_pos(&needle, &of_needle);
    artus_shm_pos of_probe = artus_shm_pos_init();
    of_probe.sample = n;
    of_probe.present = ARTUS_SHM_PROBE;
    of_probe.probe_position[1] = 0.02;
    artus_shm_write_pos(&probe, &of_probe);
    heard = (*device)->read(static_cast<std::int64_t>(artus_shm_now_ns()));
  }
  EXPECT_EQ(heard.has_needle, 1U);
  EXPECT_EQ(heard.has_probe, 1U);
  EXPECT_EQ(heard.X_WP.position[1], 0.02);
  DeviceFeedback feedback;
  feedback.answers = heard.number;
  feedback.time_ns = static_cast<std::int64_t>(artus_shm_now_ns());
  (*device)->write(feedback);
  artus_shm_force felt{};
  EXPECT_EQ(artus_shm_read_force(&probe, &felt), 1);
  EXPECT_EQ(felt.pos_sample, 103U);
  EXPECT_EQ(felt.probe_sample, 3U);
  artus_shm_close(&needle);
  artus_shm_close(&probe);
}

TEST_F(DevicePrograms, AForceThatArtusCannotHaveWrittenIsNotFelt) {
  auto channel =
      SharedChannel<artus_shm_force>::open(prefix_, kForceLayout, SegmentAccess::owner_writes);
  ASSERT_TRUE(channel);
  artus_shm_link link{};
  ASSERT_EQ(artus_shm_open(&link, prefix_.c_str()), 0);
  const auto read_back = [&](double artus_shm_force::*member, double value) {
    artus_shm_force sent{};
    sent.time_ns = artus_shm_now_ns();
    sent.force[0] = 2;
    sent.*member = value;
    channel->write(sent);
    artus_shm_force felt{};
    const int fresh = artus_shm_read_force(&link, &felt);
    EXPECT_TRUE(fresh == 1 || (felt.force[0] == 0 && felt.thumb_force == 0));
    EXPECT_EQ((felt.status & ARTUS_SHM_FORCE_INVALID) != 0, fresh == 0);
    return fresh;
  };
  EXPECT_EQ(read_back(&artus_shm_force::thumb_force, 3), 1);
  for (const double wrong : {std::numeric_limits<double>::infinity(), 1e6, -101.0,
                             std::numeric_limits<double>::quiet_NaN()})
    EXPECT_EQ(read_back(&artus_shm_force::thumb_force, wrong), 0) << wrong;
  artus_shm_force far{};
  far.force[1] = 80;
  EXPECT_EQ(artus_shm_is_force(&far), 1);
  far.force[2] = 80;
  EXPECT_EQ(artus_shm_is_force(&far), 0) << "its length counts";
  artus_shm_force twisted{};
  twisted.probe_torque[0] = std::numeric_limits<double>::infinity();
  EXPECT_EQ(artus_shm_is_force(&twisted), 0);
  EXPECT_EQ(read_back(&artus_shm_force::thumb_force, 3), 1) << "the next sound one is served";
  artus_shm_close(&link);
}

/// A whole tick, fed by a device.
class DeviceTicks : public ::testing::Test {
 protected:
  HapticSnapshot step(HapticCore& core, DeviceSample device, std::int64_t every_ns = 0) {
    TickInput input;
    input.tick = ++tick_;
    input.device = device;
    const auto now = static_cast<std::int64_t>(tick_) * test::kTickTime;
    input.device.time_ns = every_ns > 0 ? now - now % every_ns : now;
    return core.step(input);
  }
  std::shared_ptr<const Scene> scene_ = test::make_layered_scene();
  SessionParams params_ = test::make_small_session();
  std::uint64_t tick_ = 0;
};

TEST_F(DeviceTicks, ADeviceAtThirtyHertzFeelsForceWhileItsPoseIsHeld) {
  HapticCore core(scene_, params_);
  DeviceSample device = test::sample_at(-10e-3, 0, 1);
  device.hold_ms = 70;
  std::uint32_t faults = 0;
  double force = 0;
  for (int i = 0; i < 2000; ++i) {
    if (i % 33 == 0) device.X_WN.position[2] += i < 1300 ? 0.66e-3 : 0;
    const HapticSnapshot out = step(core, device, 33 * kTickNs);
    if (i > 40) faults |= out.status & TickStatus::kFaults;
    force = std::max(force, -out.feedback.force[2]);
  }
  EXPECT_EQ(faults, 0U);
  EXPECT_GT(force, 0.5);
}

TEST_F(DeviceTicks, AHandOutsideItsDevicesBoxFeelsNothing) {
  params_.device.needle_half = Vec3::Constant(5e-3);
  params_.device.probe_half = Vec3::Constant(5e-3);
  HapticCore core(scene_, params_);
  DeviceSample device = test::sample_at(-4e-3, 0, 1);
  device.X_WP.position[0] = 0.3;
  HapticSnapshot out = step(core, device);
  EXPECT_EQ(out.status & TickStatus::kOutOfWorkspace, 0U);
  EXPECT_NE(out.feedback.probe_status & TickStatus::kOutOfWorkspace, 0U);
  device.X_WN.position[2] = -6e-3;
  out = step(core, device);
  EXPECT_NE(out.status & TickStatus::kOutOfWorkspace, 0U);
}

TEST_F(DeviceTicks, TheProbesHandIsKeptWithinItsOwnDevicesLimits) {
  for (const char* name : {"touch", "delta"}) {
    params_.device = with_probe_device(*find_device("virtuose_6d_desktop"), *find_device(name));
    HapticCore core(scene_, params_);
    const DeviceSample device = test::sample_at(-10e-3, 0, 1);
    const Pose X_JP = to_pose(device.X_WP);
    const TissuePacket packet{test::pressing_packet(X_JP, 30), {}};
    core.take(packet);
    double most = 0;
    for (int i = 0; i < 2000; ++i) {
      const HapticSnapshot out = step(core, device);
      const auto& f = out.feedback.probe_force;
      most = std::max(most, Vec3(f[0], f[1], f[2]).norm());
    }
    EXPECT_GT(most, 2.9) << name;
    EXPECT_LE(most, params_.device.probe_force * (1 + 1e-9)) << name;
  }
}

TEST_F(DeviceTicks, APlungerThatJumpsIsRefusedAndToldAndMovesNothing) {
  HapticCore core(scene_, params_);
  DeviceSample device = test::sample_at(-10e-3, 0, 1);
  device.plunger = PlungerSign::travel;
  for (int i = 0; i < 500; ++i) {
    device.plunger_travel += 1e-6;
    EXPECT_EQ(step(core, device).feedback.plunger.status & PlungerStatus::kJumped, 0U);
  }
  const double before = core.last().feedback.plunger.travel;
  device.plunger_travel = 0.9;
  HapticSnapshot out = step(core, device);
  EXPECT_NE(out.feedback.plunger.status & PlungerStatus::kJumped, 0U);
  EXPECT_EQ(out.feedback.plunger.thumb_force, 0);
  for (int i = 0; i < 600; ++i) out = step(core, device);
  EXPECT_NEAR(out.feedback.plunger.travel, before, 0.1e-3);
  EXPECT_EQ(out.feedback.plunger.status & PlungerStatus::kJumped, 0U) << "it is told for a while";
}

TEST_F(DeviceTicks, APlungerOfASlowDeviceMayMoveInItsOwnSteps) {
  HapticCore core(scene_, params_);
  DeviceSample device = test::sample_at(-10e-3, 0, 1);
  device.plunger = PlungerSign::travel;
  device.hold_ms = 70;
  for (int i = 0; i < 500; ++i) {
    if (i % 33 == 0) device.plunger_travel += 1.5e-3;  // 45 mm/s at 30 Hz, between the needle's
    EXPECT_EQ(step(core, device).feedback.plunger.status & PlungerStatus::kJumped, 0U) << i;
  }
}

TEST_F(DeviceTicks, WhatWasGivenNeverFallsWhileTheThumbDrawsBack) {
  HapticCore core(scene_, params_);
  DeviceSample device = test::sample_at(-10e-3, 0, 1);  // in the air
  device.plunger = PlungerSign::force;
  double given = 0;
  for (int i = 0; i < 3000; ++i) {
    device.plunger_force = i < 1500 ? 15 : -15;
    const double now = step(core, device).feedback.plunger.given;
    ASSERT_GE(now, given) << i;
    given = now;
  }
  EXPECT_GT(given, 0.1e-6);
}

}  // namespace
}  // namespace artus
