// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/simulation/needle_tissue.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numeric>

#include <gtest/gtest.h>

#include "artus/detail/session/record/simulation_recorder.h"
#include "artus/session/replay.h"
#include "tests/session/session_support.h"
#include "tests/support/meshed_block.h"

namespace artus {
namespace {

constexpr double kSkinWall = 1500;     // N/m, as the tissue library has it
constexpr double kSkinPuncture = 1.5;  // N
constexpr double kMuscleCut = 2;       // N

std::shared_ptr<const Scene> make_needled_block() {
  const std::array<FlatLayer, 4> layers{
      {{"skin", 2e-3}, {"fat", 8e-3}, {"muscle", 20e-3}, {"bone", 10e-3}}};
  CompiledJoint joint = test::make_meshed_block(layers, 0.096, 0.064, 4e-3);
  for (Tissue& tissue : joint.tissues) {
    if (tissue.haptic.hard) continue;
    const bool skin = tissue.name == "skin";
    tissue.haptic.wall_stiffness = skin ? kSkinWall : 500;
    tissue.haptic.puncture_force = skin ? kSkinPuncture : 0;
  }
  return std::make_shared<const Scene>(std::make_shared<const CompiledJoint>(std::move(joint)));
}

SessionParams make_soft_session(bool deform) {
  SessionParams params = test::make_small_session();
  params.device = *find_device("ideal");
  params.deform = deform;
  return params;
}

/// A session without threads, recorded as it would be.
class SoftSession {
 public:
  SoftSession(std::shared_ptr<const Scene> scene, const SessionParams& params)
      : X_JP_(scene->joint().X_JP_default),
        simulation_(std::move(scene), params),
        recorder_(simulation_, recording_) {
    simulation_.prepare_imaging();
  }

  /// One tick with the tip `depth` (m) below the resting skin, beside the probe's middle.
  const HapticSnapshot& at(double depth) {
    depth_ = depth;
    return at(sample());
  }
  /// What a device says that has both hands where they are.
  [[nodiscard]] DeviceSample sample() const {
    const std::uint64_t tick = simulation_.ticks() + 1;
    DeviceSample device =
        test::sample_at(0, std::llround(1e9 * static_cast<double>(tick) / rate()), tick);
    Pose X_JN = X_JP_;
    X_JN.translation() = entry() + depth_ * axis();
    device.X_WN = to_plain(X_JN);
    Pose X_JP = X_JP_;
    X_JP.translation() += press_ * X_JP_.linear().col(2);
    device.X_WP = to_plain(X_JP);
    return device;
  }
  const HapticSnapshot& at(const DeviceSample& device) {
    TickInput input;
    input.tick = simulation_.ticks() + 1;
    input.device = device;
    return recorder_.step(input);
  }
  /// From where the tip is, m/s.
  const HapticSnapshot& move(double depth, double speed) {
    const double from = depth_;
    const int n = std::max(1, static_cast<int>(std::abs(depth - from) / speed * rate()));
    for (int k = 1; k < n; ++k) at(from + (depth - from) * k / n);
    return at(depth);
  }
  const HapticSnapshot& hold(double seconds) {
    for (int k = 1; k < seconds * rate(); ++k) at(depth_);
    return at(depth_);
  }
  void press(double by) { press_ = by; }
  [[nodiscard]] double depth() const { return depth_; }
  [[nodiscard]] Vec3 entry() const { return X_JP_ * Vec3(4e-3, 11e-3, 0); }
  [[nodiscard]] Vec3 axis() const { return X_JP_.linear().col(2); }
  [[nodiscard]] const Scene& now() const { return *simulation_.scene(); }
  [[nodiscard]] const Simulation& simulation() const { return simulation_; }
  [[nodiscard]] const Recording& recording() const { return recording_; }

 private:
  [[nodiscard]] double rate() const { return simulation_.params().haptic_rate; }

  Pose X_JP_;
  Simulation simulation_;
  Recording recording_;
  SimulationRecorder recorder_;
  double depth_ = -10e-3;
  double press_ = -20e-3;
};

/// m the tip is below the resting skin when it goes in.
double punctured_at(SoftSession& session) {
  double depth = 0;
  while (session.at(depth).inserted == 0 && depth < 20e-3) depth += 1e-5;
  return depth;
}

/// m by which the tissue at the tip was pushed in, by the hand's law and in the picture.
double tent_in_hand(const HapticSnapshot& out, double depth) {
  return depth - out.feedback.depth;
}
double tent_in_picture(const SoftSession& session, double depth) {
  const Vec3 tip = session.entry() + depth * session.axis();
  return (tip - session.now().tissue()->to_rest(tip).p_rest).dot(session.axis());
}

double sum_of_shaft(const NeedleLoad& load) {
  return std::accumulate(load.shaft.begin(), load.shaft.end(), 0.0);
}

TEST(NeedleTissue, TentsAndDragsInTheHandAsInThePictureAndRestsAsRigidTissueDoes) {
  const auto scene = make_needled_block();
  SoftSession rigid(scene, make_soft_session(false));
  SoftSession soft(scene, make_soft_session(true));
  ASSERT_TRUE(soft.simulation().refusal().empty()) << soft.simulation().refusal();
  for (SoftSession* session : {&rigid, &soft}) {
    session->move(-1e-3, 20e-3);
    session->hold(0.6);
    session->move(0.6e-3, 5e-3);
  }
  const HapticSnapshot pressed = soft.hold(1);
  ASSERT_EQ(pressed.inserted, 0U);
  const double tent = tent_in_hand(pressed, 0.6e-3);
  const double compliance = max_tissue_compliance(kSkinWall);
  EXPECT_NEAR(tent, -pressed.axial[0] * compliance, 0.1 * tent);  // the cubes are not linear
  EXPECT_NEAR(tent_in_picture(soft, 0.6e-3), tent, 0.05 * tent);
  // It gives way at the same force, so later by what the tissue gave way before.
  EXPECT_NEAR(punctured_at(soft) - punctured_at(rigid), kSkinPuncture * compliance, 0.15e-3);
  const HapticSnapshot cutting = soft.move(15e-3, 10e-3);
  EXPECT_NEAR(cutting.axial[1], rigid.move(15e-3, 10e-3).axial[1], 0.02 * kMuscleCut);
  EXPECT_GT(sum_of_shaft(cutting.load), 0);
  EXPECT_NEAR(tent_in_picture(soft, 15e-3), tent_in_hand(cutting, 15e-3), 0.2e-3);
  // A hand that rests: the force of the cut fades, and the tissue comes onto the needle.
  EXPECT_LT(-soft.hold(0.5).axial[1], 0.05 * kMuscleCut);
  EXPECT_LT(-rigid.hold(0.5).axial[1], 0.05 * kMuscleCut);
  EXPECT_LT(tent_in_picture(soft, 15e-3), 0.2 * tent_in_hand(cutting, 15e-3));
  const HapticSnapshot back = soft.move(10e-3, 10e-3);
  EXPECT_LT(sum_of_shaft(back.load), 0);
  EXPECT_LT(tent_in_picture(soft, 10e-3), 0) << "the way out drags the tissue out";
  soft.move(-10e-3, 50e-3);
  const HapticSnapshot out = soft.hold(1.5);
  EXPECT_EQ(sum_of_shaft(out.load), 0);
  EXPECT_EQ(out.load.tip, 0);
  for (const Vec3& u : soft.now().tissue()->node_displacements()) EXPECT_LT(u.norm(), 1e-6);
}

TEST(NeedleTissue, MeetsTheSkinWhereThePressedProbeHasItInThePicture) {
  SoftSession soft(make_needled_block(), make_soft_session(true));
  for (int k = 0; k <= 100; ++k) {
    soft.press(3e-5 * k);
    soft.hold(0.01);
  }
  soft.move(-3e-3, 20e-3);
  soft.hold(1);
  double depth = -3e-3;
  while (soft.at(depth).axial[0] == 0 && depth < 10e-3) depth += 5e-6;
  const double moved = tent_in_picture(soft, depth);
  EXPECT_GT(moved, 0.3e-3) << "the skin beside the face goes in with it";
  const Vec3 tip = soft.entry() + depth * soft.axis();
  EXPECT_NEAR(soft.now().signed_distance_to_skin(tip, 10e-3), 0, 0.1e-3);
  EXPECT_NEAR(depth, moved, 0.1e-3);
}

TEST(NeedleTissue, ReplaysByteForByteAtAnyNumberOfThreads) {
  const auto scene = make_needled_block();
  SoftSession soft(scene, make_soft_session(true));
  soft.press(1e-3);
  soft.move(-1e-3, 60e-3);
  soft.hold(0.25);
  soft.move(7e-3, 40e-3);
  soft.move(5e-3, 40e-3);
  Recording recording = soft.recording();
  ASSERT_TRUE(std::any_of(recording.frames.begin(), recording.frames.end(),
                          [](const FrameRecord& f) { return f.input.load.tip > 0; }));
  for (const int threads : {1, 2}) {
    const auto report = replay(recording, scene, {}, threads);
    ASSERT_TRUE(report) << report.error().to_string();
    EXPECT_EQ(report->different_ticks, 0U) << *report->first_different_tick;
    EXPECT_EQ(report->different_frames, 0U) << *report->first_different_frame;
  }
  // What it compares can be told apart: another compliance is felt, another load is seen.
  for (PacketRecord& packet : recording.packets)
    for (auto& column : packet.packet.needle.compliance.by_load)
      for (double& c : column) c *= 0.25;
  for (FrameRecord& frame : recording.frames) frame.input.load.tip *= 2;
  const auto other = replay(recording, scene);
  ASSERT_TRUE(other);
  EXPECT_GT(other->different_ticks, 100U);
  EXPECT_GT(other->different_frames, 3U);
}

/// Force on each hand along the needle and the beam, N.
Vec3 felt_by(const HapticSnapshot& out) {
  return {
      Vec3(out.force_J[0], out.force_J[1], out.force_J[2]).norm(),
      Vec3(out.feedback.probe_force[0], out.feedback.probe_force[1], out.feedback.probe_force[2])
          .norm(),
      0};
}

/// A probe that presses and a needle that goes in, smoothly: what the ticks in which the tissue's
/// answer is a new one add to the change of the tick before (a hand that goes in by 7 um a tick on
/// 1500 N/m feels 10 mN more in each) is no more than half a just-noticeable difference (7 %,
/// assumed).
TEST(NeedleTissue, NewAnswersOfTheTissueAreNoStepsInTheHands) {
  SoftSession soft(make_needled_block(), make_soft_session(true));
  constexpr double kHalfJnd = 0.035;
  constexpr double kWeak = 0.3;  // N, below which a share of it says nothing
  Vec3 before = Vec3::Zero();
  Vec3 change = Vec3::Zero();
  Vec3 worst = Vec3::Zero();
  std::size_t answers = 0;
  std::size_t compliances = 0;
  double depth = -12e-3;
  for (int k = 0; k < 4000; ++k) {
    soft.press(-4e-3 + 8e-3 * std::min(1.0, k / 2000.0));
    depth += k < 800 ? 1e-5 : 7e-6;
    const std::size_t known = soft.recording().packets.size();
    const HapticSnapshot out = soft.at(depth);
    const auto& packets = soft.recording().packets;
    const bool fresh = known >= 1 && packets[known - 1].tick == out.input.tick;
    const bool happened = (out.events & ~ContactEvent::kRedirected) != 0;
    const Vec3 now = felt_by(out);
    if (fresh && !happened && k > 500) {
      ++answers;
      for (Eigen::Index i = 0; i < 2; ++i)
        worst[i] =
            std::max(worst[i], std::abs(now[i] - before[i] - change[i]) / std::max(now[i], kWeak));
    }
    change = now - before;
    before = now;
    compliances += known >= 2 && packets[known - 1].packet.needle.compliance.by_load !=
                                     packets[known - 2].packet.needle.compliance.by_load;
  }
  EXPECT_GT(answers, 50U);
  EXPECT_GT(compliances, 0U);
  EXPECT_GT(before.x(), 1) << "the needle cuts";
  EXPECT_GT(before.y(), 1) << "the probe presses";
  EXPECT_LT(worst.x(), kHalfJnd);
  EXPECT_LT(worst.y(), kHalfJnd);
}

/// What a device's program may do to a session: jump, send what is no pose, press beyond reason, go
/// through bone, fall silent. Forces stay finite and within limits, faults are told in the tick in
/// which they are met, nobody who does nothing wrong is left without force, and the tissue comes to
/// rest again.
/// What tissue does that is pressed far, less than its compliance says, is no motion by others: it
/// does not stay when a wall gives way.
TEST(NeedleTissue, GoingInTheTipIsNeverDeeperInTheMaterialThanInSpace) {
  const std::array<FlatLayer, 6> layers{{{"skin", 2e-3},
                                         {"fat", 4e-3},
                                         {"muscle", 12e-3},
                                         {"bursa", 2e-3},
                                         {"tendon", 8e-3},
                                         {"bone", 8e-3}}};
  CompiledJoint joint = test::make_meshed_block(layers, 0.096, 0.064, 4e-3);
  for (Tissue& tissue : joint.tissues) {
    if (tissue.haptic.hard) continue;
    tissue.haptic.wall_stiffness = 350;
    tissue.haptic.puncture_force = tissue.name == "skin" ? kSkinPuncture : 0;
    if (tissue.name == "bursa") tissue.haptic.puncture_force = 3;
  }
  const auto scene =
      std::make_shared<const Scene>(std::make_shared<const CompiledJoint>(std::move(joint)));
  SoftSession session(scene, make_soft_session(true));
  session.hold(1);
  session.at(-5e-3);
  double deeper = -1;                                         // m than in space
  double tented = 0;                                          // m less deep, at most
  RegionId deepest = 0;                                       // layer of the tip
  for (double depth = -5e-3; depth < 27e-3; depth += 1e-5) {  // 10 mm/s
    const HapticSnapshot& out = session.at(depth);
    deeper = std::max(deeper, out.feedback.depth - std::max(depth, 0.0));
    tented = std::max(tented, depth - out.feedback.depth);
    deepest = std::max(deepest, static_cast<RegionId>(out.feedback.region));
  }
  EXPECT_GT(tented, 1e-3);
  EXPECT_LT(deeper, 0.3e-3);
  EXPECT_EQ(deepest, region_named(scene->joint(), "tendon"));
}

TEST(NeedleTissue, HandsThatDoWhatNoHandDoesAreSafeAndTheTissueIsBackAtRest) {
  for (const double rate : {1000.0, 5000.0}) {
    SessionParams params = make_soft_session(true);
    params.haptic_rate = rate;
    SoftSession soft(make_needled_block(), params);
    double most = 0;
    const auto check = [&](const HapticSnapshot& out) {
      const Vec3 felt = felt_by(out);
      ASSERT_TRUE(felt.allFinite());
      most = std::max(most, felt.maxCoeff());
      ASSERT_LE(felt.x(), params.device.force + 1e-9);
      if ((out.status & TickStatus::kFaults) != 0) {
        ASSERT_EQ(felt.x(), 0);
      }
    };
    const auto run = [&](double seconds, double speed) {
      for (int k = 0; k < seconds * rate; ++k) check(soft.at(soft.depth() + speed / rate));
    };
    soft.move(-1e-3, 60e-3);
    soft.press(2e-3);
    soft.hold(0.5);
    EXPECT_GT(felt_by(soft.hold(0.05)).y(), 0.1);
    run(0.25, 40e-3);
    EXPECT_GT(felt_by(soft.hold(0.01)).x(), 0.5);
    // The needle jumps by 50 mm: told at once, and felt again after the ramp.
    const HapticSnapshot jumped = soft.at(soft.depth() - 50e-3);
    EXPECT_NE(jumped.status & TickStatus::kTeleport, 0U);
    check(jumped);
    EXPECT_GT(felt_by(jumped).y(), 0.1) << "the probe's hand did nothing wrong";
    check(soft.at(soft.depth() + 50e-3));
    soft.hold(0.3);
    run(0.1, 30e-3);
    EXPECT_GT(felt_by(soft.hold(0.01)).x(), 0.3) << "a needle that moves on is felt";
    // No pose at all.
    DeviceSample wrong = soft.sample();
    wrong.X_WN.position[1] = std::nan("");
    wrong.X_WP.position[0] = std::nan("");
    const HapticSnapshot refused = soft.at(wrong);
    EXPECT_NE(refused.status & SessionStatus::kPeerInvalid, 0U);
    EXPECT_EQ(felt_by(refused).x(), 0);
    EXPECT_EQ(felt_by(refused).y(), 0);
    // Through the bone, and the probe 30 mm in, at once.
    soft.press(30e-3);
    run(0.5, 100e-3);
    soft.press(2e-3);
    // Silent, then out.
    DeviceSample lost = soft.sample();
    lost.state = PeerState::lost;
    for (int k = 0; k < 100; ++k) check(soft.at(lost));
    soft.press(-20e-3);
    soft.move(-10e-3, 100e-3);
    const HapticSnapshot out = soft.hold(3);  // crushed tissue comes back slowly
    EXPECT_EQ(out.status & TickStatus::kFaults, 0U);
    EXPECT_EQ(felt_by(out), Vec3::Zero());
    EXPECT_GT(most, 2);
    for (const Vec3& u : soft.now().tissue()->node_displacements()) ASSERT_LT(u.norm(), 1e-6);
  }
}

}  // namespace
}  // namespace artus
