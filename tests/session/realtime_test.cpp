// SPDX-License-Identifier: AGPL-3.0-or-later
// Every function of the session's tick under the allocation and lock counters.
#include <memory>

#include <unistd.h>

#include <gtest/gtest.h>

#include "artus/detail/session/hand_device.h"
#include "artus/detail/session/haptic_loop.h"
#include "artus/detail/session/injecting_device.h"
#include "artus/detail/session/record/dropping_ring.h"
#include "artus/detail/session/record/recorded_device.h"
#include "artus/detail/session/record/recorder.h"
#include "artus/detail/session/session_exchange.h"
#include "artus/detail/simulation/hand_aids.h"
#include "artus/detail/simulation/haptic_core.h"
#include "artus/detail/simulation/simulated_hands.h"
#include "artus/haptics/needle_renderer.h"
#include "artus/session/recording.h"
#include "artus/session/shared_memory_device.h"
#include "artus/simulation/simulation.h"
#include "tests/session/session_support.h"
#include "tests/support/real_time.h"
#include "tests/support/temporary_folder.h"

namespace artus {
namespace {

using test::use;

/// Reads and writes a device for `ticks` ms under the counters.
template <class Device>
void run_device(Device& device, int ticks) {
  for (int i = 0; i < ticks; ++i) {
    use(device.read(i * test::kTickTime));
    device.write({});
  }
}

HandTarget hand_at(double z) {
  HandTarget hand;
  hand.X_WN.position[2] = z;
  return hand;
}

TEST(RealTimeSession, HandsAndRecordingsNeitherAllocateNorLock) {
  HandDevice hand(hand_at(0), 1e-3);
  hand.set_target(hand_at(0.05));
  ARTUS_RUNS_REALTIME(HandDevice::read, use(hand.read(0)), run_device(hand, 500));
  ARTUS_RUNS_REALTIME(HandDevice::write, hand.write({}));
  ARTUS_RUNS_REALTIME(approach, use(approach({}, hand_at(1).X_WN, HandDevice::Limits{}, 1e-3)));
  ARTUS_RUNS_REALTIME(is_pose, use(is_pose(hand_at(1).X_WN)));
  ARTUS_RUNS_REALTIME(blend, use(blend({}, hand_at(1).X_WN, 0.5)));
  ARTUS_RUNS_REALTIME(rotation_of, use(rotation_of(hand_at(1).X_WN)));
  RecordedDevice record({test::sample_at(0, 0, 1), test::sample_at(1e-3, 1, 2)});
  ARTUS_RUNS_REALTIME(RecordedDevice::read, use(record.read(0)), run_device(record, 5));
  ARTUS_RUNS_REALTIME(RecordedDevice::write, record.write({}));
}

TEST(RealTimeSession, TheInjectingHandNeitherAllocatesNorLocks) {
  InjectionPlan plan;
  InjectingDevice device(plan, *find_device("virtuose_6d_desktop"), 1000);
  DeviceSample sample;
  ARTUS_RUNS_REALTIME(InjectingDevice::read, sample = device.read(0), run_device(device, 3000));
  EXPECT_EQ(sample.has_needle, 1U);
  ARTUS_RUNS_REALTIME(InjectingDevice::write, device.write({}));
}

TEST(RealTimeSession, SimulatedHandsNeitherAllocateNorLock) {
  OperatorPhase gives = stay(1);
  gives.thumb_rate = 1e-7;
  gives.until_given = true;
  const InjectionOperator person(Vec3::Zero(), Vec3::UnitZ(), -5e-3, {gives});
  SimulatedHands hands;
  hands.take_up(HandLoop({1000, 4000}, *find_device("touch"), {}, person.start()));
  hands.set_thumb(DosingThumb(PlungerParams{}, 1e-6, 1000));
  DeviceSample sample;
  ARTUS_RUNS_REALTIME(SimulatedHands::hold_probe, hands.hold_probe(person.start()));
  ARTUS_RUNS_REALTIME(SimulatedHands::read, sample = hands.read(&gives));
  ARTUS_RUNS_REALTIME(SimulatedHands::feel, hands.feel({}));
  ARTUS_RUNS_REALTIME(SimulatedHands::move, hands.move(person));
  EXPECT_EQ(sample.has_needle, 1U);
  EXPECT_EQ(sample.has_probe, 1U);
  DosingThumb& thumb = hands.thumb();
  ARTUS_RUNS_REALTIME(DosingThumb::begin, thumb.begin());
  ARTUS_RUNS_REALTIME(DosingThumb::press, thumb.press(&gives, sample));
  EXPECT_EQ(sample.plunger, PlungerSign::travel);
  ARTUS_RUNS_REALTIME(DosingThumb::feel, thumb.feel({}));
}

TEST(RealTimeSession, TheSyringeNeitherAllocatesNorLocks) {
  const auto scene = test::make_layered_scene();
  SyringeCore syringe(scene->joint(), test::make_small_session());
  const LayerTable table = make_layer_table(scene->joint(), {});
  const NeedleContact contact({}, {}, table, 1e-3);
  DeviceSample sample = test::sample_at(5e-3, test::kTickTime, 1);
  sample.plunger = PlungerSign::force;
  sample.plunger_force = 20;
  ARTUS_RUNS_REALTIME(SyringeCore::step,
                      for (int k = 0; k < 500; ++k) syringe.step(sample, contact));
  EXPECT_GT(syringe.feedback().given, 0);
  ARTUS_RUNS_REALTIME(SyringeCore::rest, syringe.rest());
  ARTUS_RUNS_REALTIME(SyringeCore::reset, syringe.reset());
}

TEST(RealTimeSession, AidsOfTheHandNeitherAllocateNorLock) {
  const auto scene = test::make_layered_scene();
  HandAid aid(scene->joint(), {Vec3::Zero(), Vec3::UnitZ(), 300, 1000, "muscle\nbursa"}, 1e-3);
  const auto needle = make_needle_renderer(scene, "virtuose_6d_desktop", 1000);
  ASSERT_TRUE(needle);
  Vec3 most = Vec3::Zero();
  ARTUS_RUNS_REALTIME(
      HandAid::step, for (int k = 0; k < 2000; ++k) {
        const Vec3 tip(1e-3, 0, -2e-3 + 1e-5 * k);
        (*needle)->step({make_pose(tip, Vec3::UnitZ(), Vec3::UnitX()), 1e-3 * k});
        most = most.cwiseMin(aid.step((*needle)->model().contact(), tip, true));
      });
  EXPECT_LT(most.x(), -0.1);
  EXPECT_LT(most.z(), -0.1);
}

TEST(RealTimeSession, CoreAndLoopNeitherAllocateNorLockOnTheWayToBone) {
  const auto scene = test::make_layered_scene();
  Simulation core(scene, test::make_small_session());
  HapticCore half(scene, test::make_small_session());
  const auto renderer = make_needle_renderer(scene, "virtuose_6d_desktop", 1000);
  ASSERT_TRUE(renderer);
  bool inserted = false;
  for (int i = 0; i < 2000; ++i) {
    TickInput input;
    input.tick = static_cast<std::uint64_t>(i) + 1;
    input.device = test::sample_at(-5e-3 + 2e-5 * i, i * test::kTickTime, input.tick);
    if (i == 1500) input.device.X_WN.position[0] = std::nan("");
    if (i % 2 == 0) {
      ARTUS_RUNS_REALTIME(HapticCore::step, use(half.step(input)));
    } else {
      TimedPose pose{to_pose(input.device.X_WN), 1e-3 * i};
      ARTUS_RUNS_REALTIME(NeedleRenderer::feel, use((*renderer)->feel(pose)));
      ARTUS_RUNS_REALTIME(NeedleRenderer::command, use((*renderer)->command(Vec3(0, 0, 1))));
    }
    ARTUS_RUNS_REALTIME(Simulation::tick, inserted = core.tick(input).inserted != 0 || inserted);
    ARTUS_RUNS_REALTIME(to_record, use(to_record(core.tick(input))));
    TissuePacket packet;
    packet.probe.number = input.tick;
    packet.needle.carried = {0, 1e-4, 1e-5 * i};
    packet.needle.compliance = test::make_even_compliance();
    ARTUS_RUNS_REALTIME(Simulation::take, core.take(packet));
    ARTUS_RUNS_REALTIME(HapticCore::take, half.take(packet));
  }
  EXPECT_TRUE(inserted);
  HandDevice device(hand_at(-5e-3), 1e-3);
  Seqlock<HapticSnapshot> newest;
  LatencyHistogram compute;
  LatencyHistogram cpu;
  LatencyHistogram lateness;
  HapticLoop loop(core, device, 1000, newest, {compute, cpu, lateness});
  ARTUS_RUNS_REALTIME(HapticLoop::step, use(loop.step(0)), use(loop.step(SessionCommand::kPause)));
  EXPECT_EQ(loop.ticks(), 2U);
}

TEST(RealTimeSession, TheGestureNeitherAllocatesNorLocks) {
  const auto scene = test::make_layered_scene();
  const GestureParams params;
  const Pose X_WP = make_pose(Vec3(0.02, 0.01, 0), Vec3::UnitZ(), Vec3::UnitX());
  std::optional<EntryChoice> choice;
  ARTUS_RUNS_REALTIME(choose_entry, choice = choose_entry(*scene, X_WP, params));
  ASSERT_TRUE(choice);
  ARTUS_RUNS_REALTIME(calibrate_joint, use(calibrate_joint(Pose::Identity(), *choice, params)));
  TwoPhaseGesture gesture(params, Pose::Identity());
  bool moved = false;
  ARTUS_RUNS_REALTIME(TwoPhaseGesture::step,
                      moved = gesture.step(*scene, Button::kCalibrate, X_WP));
  EXPECT_TRUE(moved);
  ARTUS_RUNS_REALTIME(TwoPhaseGesture::reset, gesture.reset());
}

TEST(RealTimeSession, ExchangesBetweenThreadsNeitherAllocateNorLock) {
  Seqlock<HapticSnapshot> lock;
  HapticSnapshot value;
  ARTUS_RUNS_REALTIME(Seqlock::store, lock.store(value));
  ARTUS_RUNS_REALTIME(Seqlock::store_prefix, lock.store_prefix(value, 64));
  ARTUS_RUNS_REALTIME(Seqlock::try_load, use(lock.try_load(value)));
  ARTUS_RUNS_REALTIME(Seqlock::load, use(lock.load(value)));
  ARTUS_RUNS_REALTIME(Seqlock::sequence, use(lock.sequence()));
  NewestMailbox<std::vector<int>> mailbox;
  ARTUS_RUNS_REALTIME(NewestMailbox::publish, mailbox.publish());
  DroppingRing<int> ring(2);
  int out = 0;
  ARTUS_RUNS_REALTIME(DroppingRing::push, ring.push(1), ring.push(2), ring.push(3));
  ARTUS_RUNS_REALTIME(DroppingRing::pop, use(ring.pop(out)));
  EXPECT_EQ(out, 1);
}

TEST(RealTimeSession, ClocksAndCountsNeitherAllocateNorLock) {
  LatencyHistogram histogram;
  ARTUS_RUNS_REALTIME(LatencyHistogram::add, histogram.add(1000));
  ARTUS_RUNS_REALTIME(LatencyHistogram::add_with_missed,
                      histogram.add_with_missed(5 * test::kTickTime, test::kTickTime));
  EXPECT_EQ(histogram.count(), 6U);
  ARTUS_RUNS_REALTIME(monotonic_ns, use(monotonic_ns()));
  ARTUS_RUNS_REALTIME(thread_cpu_ns, use(thread_cpu_ns()));
  LateWatch watch(test::kTickTime);
  ARTUS_RUNS_REALTIME(LateWatch::step, use(watch.step(30 * test::kTickTime)));
}

class RealTimeFiles : public test::TemporaryFolder {};

TEST_F(RealTimeFiles, RecordingATickOrAFrameNeitherAllocatesNorLocks) {
  const auto scene = test::make_layered_scene();
  const auto recorder =
      Recorder::start(in("a.rec"), make_head(scene->joint(), test::make_small_session()));
  ASSERT_TRUE(recorder) << recorder.error().to_string();
  const TickRecord tick;
  const FrameRecord frame;
  ARTUS_RUNS_REALTIME(Recorder::add, (*recorder)->add(tick));
  ARTUS_RUNS_REALTIME(Recorder::add, (*recorder)->add(frame));
  const PacketRecord packet;
  ARTUS_RUNS_REALTIME(Recorder::add, (*recorder)->add(packet));
  EXPECT_EQ((*recorder)->dropped(), 0U);
}

/// Names of their own, gone afterwards.
class RealTimeSharedMemory : public testing::Test {
 protected:
  ~RealTimeSharedMemory() override {
    for (const SegmentLayout& layout : {kPosLayout, kForceLayout})
      SharedSegment::remove(prefix_, layout);
  }
  std::string prefix_ = "artus-real-time-" + std::to_string(getpid()) + "-";
};

TEST_F(RealTimeSharedMemory, ChannelsNeitherAllocateNorLock) {
  using Reopened = ReopeningChannel<artus_shm_force>;
  auto reopened = Reopened::open(prefix_, kForceLayout, SegmentAccess::owner_writes);
  ASSERT_TRUE(reopened) << reopened.error().to_string();
  SharedChannel<artus_shm_force>* channel = nullptr;
  ARTUS_RUNS_REALTIME(ReopeningChannel::use, channel = &(*reopened)->use());
  artus_shm_force force{};
  ARTUS_RUNS_REALTIME(SharedChannel::write, channel->write(force));
  ARTUS_RUNS_REALTIME(SharedChannel::write_prefix, channel->write_prefix(force, 64));
  bool whole = false;
  ARTUS_RUNS_REALTIME(SharedChannel::read, whole = channel->read(force));
  EXPECT_TRUE(whole);
  auto segment = SharedSegment::open(prefix_, kPosLayout, SegmentAccess::owner_writes);
  ASSERT_TRUE(segment);
  ARTUS_RUNS_REALTIME(SharedSegment::beat, segment->beat());
  ARTUS_RUNS_REALTIME(SharedSegment::writer_pid, use(segment->writer_pid()));
  ARTUS_RUNS_REALTIME(SharedSegment::opened_ns, use(segment->opened_ns()));
}

TEST_F(RealTimeSharedMemory, TheDeviceBehindItNeitherAllocatesNorLocks) {
  PosReader reader;
  artus_shm_pos pos = artus_shm_pos_init();
  pos.sample = 1;
  ARTUS_RUNS_REALTIME(join_hands, use(join_hands(test::sample_at(0, 0, 1), {})));
  ARTUS_RUNS_REALTIME(PosReader::accept, use(reader.accept(true, pos, test::kTickTime)));
  auto device = SharedMemoryDevice::open(prefix_, {"outside", "beyond", "skin"});
  ASSERT_TRUE(device) << device.error().to_string();
  DeviceFeedback feedback;
  feedback.region = 2;
  ARTUS_RUNS_REALTIME(SharedMemoryDevice::write, (*device)->write(feedback));
  ARTUS_RUNS_REALTIME(SharedMemoryDevice::read, use((*device)->read(test::kTickTime)));
}

}  // namespace
}  // namespace artus
