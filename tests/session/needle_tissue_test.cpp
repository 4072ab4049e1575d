// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/session/needle_tissue.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "artus/session/image_core.h"
#include "artus/session/replay.h"
#include "tests/session/session_support.h"
#include "tests/support/meshed_block.h"

namespace artus {
namespace {

std::shared_ptr<const Scene> make_needled_block() {
  const std::array<FlatLayer, 4> layers{
      {{"skin", 2e-3}, {"fat", 8e-3}, {"muscle", 20e-3}, {"bone", 10e-3}}};
  return std::make_shared<const Scene>(std::make_shared<const CompiledJoint>(
      test::make_meshed_block(layers, 0.096, 0.064, 4e-3)));
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
    input.device = test::sample_at(0, static_cast<std::int64_t>(1e6) * static_cast<std::int64_t>(input.tick), input.tick);
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
    FrameRecord frame;
    frame.input = frame_input(out, controls_of(params_), recording_.frames.size() + 1);
    frame.digest = digest_of(images_.render(frame.input));
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

TEST(NeedleTissue, SkinTentsInTheHandAndInThePictureBeforeItGivesWay) {
  const auto scene = make_needled_block();
  SoftSession rigid(scene, make_soft_session(false));
  SoftSession soft(scene, make_soft_session(true));
  ASSERT_TRUE(soft.images().refusal().empty()) << soft.images().refusal();
  for (SoftSession* session : {&rigid, &soft}) {
    session->move(-1e-3, 20e-3);
    session->hold(0.6);
  }
  // The needle presses the skin without going through it.
  rigid.move(0.6e-3, 5e-3);
  soft.move(0.6e-3, 5e-3);
  const HapticSnapshot& pressed = soft.hold(1);
  printf("inserted %u %u depth %g\n", pressed.inserted, rigid.hold(0.01).inserted, pressed.feedback.depth);
  const double force = -pressed.axial[0];
  printf("force %g tip load %g depth %g\n", force, pressed.load.tip, pressed.load.tip_depth);
  const auto& tissue = *soft.now().tissue();
  printf("picture %g\n", tissue.displacement(soft.entry()).dot(soft.axis()));
  const double hand = punctured_at(rigid);
  const double hand_soft = punctured_at(soft);
  printf("punctured %g %g\n", hand, hand_soft);
  soft.move(15e-3, 10e-3);
  const HapticSnapshot& in = soft.hold(1);
  printf("in: axial %g %g %g %g tip load %g\n", in.axial[0], in.axial[1], in.axial[2], in.axial[3], in.load.tip);
  const Vec3 tip = soft.entry() + 15e-3 * soft.axis();
  printf("picture at tip %g carried %g %g %g depth %g\n", (tip - soft.now().tissue()->to_rest(tip).p_rest).dot(soft.axis()),
     soft.images().packet()->needle.carried[0], soft.images().packet()->needle.carried[1], soft.images().packet()->needle.carried[2], in.feedback.depth);
  rigid.move(15e-3, 10e-3);
  const HapticSnapshot& inr = rigid.hold(1);
  printf("in rigid: axial %g %g %g %g depth %g\n", inr.axial[0], inr.axial[1], inr.axial[2], inr.axial[3], inr.feedback.depth);
  EXPECT_GT(hand_soft, hand);
}

}  // namespace
}  // namespace artus
