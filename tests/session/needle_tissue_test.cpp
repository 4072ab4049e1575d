// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/session/needle_tissue.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numeric>

#include <gtest/gtest.h>

#include "artus/session/image_core.h"
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

/// A session without threads: hand and image by turns, as they run live.
class SoftSession {
 public:
  SoftSession(std::shared_ptr<const Scene> scene, const SessionParams& params)
      : params_(params), haptics_(scene, params), images_(scene, params) {
    recording_.head = make_head(scene->joint(), params);
    X_JP_ = scene->joint().X_JP_default;
  }

  /// One tick with the tip `depth` (m) below the resting skin, beside the probe's middle.
  const HapticSnapshot& at(double depth) {
    TickInput input;
    input.tick = recording_.ticks.size() + 1;
    input.device = test::sample_at(
        0, static_cast<std::int64_t>(1e6) * static_cast<std::int64_t>(input.tick), input.tick);
    Pose X_JN = X_JP_;
    X_JN.translation() = entry() + depth * axis();
    input.device.X_WN = to_plain(X_JN);
    Pose X_JP = X_JP_;
    X_JP.translation() += press_ * X_JP_.linear().col(2);
    input.device.X_WP = to_plain(X_JP);
    depth_ = depth;
    const HapticSnapshot& out = haptics_.step(input);
    recording_.ticks.push_back(to_record(out));
    const double images = static_cast<double>(recording_.frames.size());
    if (static_cast<double>(input.tick) * params_.image_rate >= images * params_.haptic_rate)
      draw(out);
    return out;
  }
  /// From where the tip is, m/s.
  const HapticSnapshot& move(double depth, double speed) {
    const double from = depth_;
    const int n = std::max(1, static_cast<int>(std::abs(depth - from) / speed * 1e3));
    for (int k = 1; k < n; ++k) at(from + (depth - from) * k / n);
    return at(depth);
  }
  const HapticSnapshot& hold(double seconds) {
    for (int k = 1; k < seconds * 1e3; ++k) at(depth_);
    return at(depth_);
  }
  void press(double by) { press_ = by; }
  [[nodiscard]] Vec3 entry() const { return X_JP_ * Vec3(4e-3, 11e-3, 0); }
  [[nodiscard]] Vec3 axis() const { return X_JP_.linear().col(2); }
  [[nodiscard]] const Scene& now() const { return *images_.scene(); }
  [[nodiscard]] const ImageCore& images() const { return images_; }
  [[nodiscard]] const Recording& recording() const { return recording_; }

 private:
  void draw(const HapticSnapshot& out) {
    const FrameInput input = frame_input(out, controls_of(params_), recording_.frames.size() + 1);
    FrameRecord frame = to_record(input, images_.render(input), images_.transducer());
    if (const TissuePacket* packet = images_.packet()) {
      frame.packet = digest_of(*packet);
      recording_.packets.push_back({out.input.tick + 1, *packet});
      haptics_.take(*packet);
    }
    recording_.frames.push_back(frame);
  }

  SessionParams params_;
  HapticCore haptics_;
  ImageCore images_;
  Recording recording_;
  Pose X_JP_;
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
  ASSERT_TRUE(soft.images().refusal().empty()) << soft.images().refusal();
  for (SoftSession* session : {&rigid, &soft}) {
    session->move(-1e-3, 20e-3);
    session->hold(0.6);
    session->move(0.6e-3, 5e-3);
  }
  const HapticSnapshot pressed = soft.hold(1);
  ASSERT_EQ(pressed.inserted, 0U);
  const double tent = tent_in_hand(pressed, 0.6e-3);
  const double compliance = most_tissue_compliance(kSkinWall);
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

}  // namespace
}  // namespace artus
