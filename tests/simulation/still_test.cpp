// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/simulation/still.h"

#include <array>
#include <cmath>
#include <memory>
#include <utility>

#include <gtest/gtest.h>

#include "artus/detail/raycast/pressed_scene.h"
#include "artus/simulation/simulation.h"
#include "tests/session/session_support.h"
#include "tests/support/meshed_block.h"

namespace artus {
namespace {

std::shared_ptr<const CompiledJoint> needled_joint() {
  const std::array<FlatLayer, 4> layers{
      {{"skin", 2e-3}, {"fat", 8e-3}, {"muscle", 20e-3}, {"bone", 10e-3}}};
  CompiledJoint joint = test::make_meshed_block(layers, 0.096, 0.064, 4e-3);
  for (Tissue& tissue : joint.tissues) {
    if (tissue.haptic.hard) continue;
    const bool skin = tissue.name == "skin";
    tissue.haptic.wall_stiffness = skin ? 1500 : 500;  // N/m, as the tissue library has it
    tissue.haptic.puncture_force = skin ? 1.5 : 0;     // N
  }
  return std::make_shared<const CompiledJoint>(std::move(joint));
}

/// A session of its own: probe at once where it presses, needle at 5 mm/s to `depth` below the skin
/// that it presses, then both held.
struct Led {
  double force = 0;
  RegionId region = kOutside;
  double moved = 0;
};
Led session_says(const std::shared_ptr<const CompiledJoint>& joint, const Press& press,
                 const Pose& X_JN, bool hold) {
  SessionParams params = test::make_small_session();
  params.device = *find_device("ideal");
  params.deform = true;
  Simulation simulation(std::make_shared<const Scene>(joint), params);
  Hands hands;
  hands.X_WP = press.X_JP;
  for (int i = 0; i < 1500; ++i) static_cast<void>(simulation.step(hands));
  const Vec3 axis = X_JN.linear().col(2);
  const auto pressed = simulation.scene()->tissue();
  for (double from = -25e-3; from <= 0; from += 10e-6) {
    hands.X_WN = X_JN * Eigen::Translation3d(0, 0, from);
    static_cast<void>(simulation.step(hands));
  }
  if (hold)
    for (int i = 0; i < 800; ++i) static_cast<void>(simulation.step(hands));
  const HapticSnapshot& tick = simulation.last();
  Led out;
  out.force = -Vec3(tick.force_J[0], tick.force_J[1], tick.force_J[2]).dot(axis);
  out.region = static_cast<RegionId>(tick.feedback.region);
  const Vec3 p_rest = simulation.scene()->tissue()->to_rest(X_JN.translation()).p_rest;
  out.moved = (simulation.scene()->tissue()->displacement(p_rest) - pressed->displacement(p_rest))
                  .dot(axis);
  return out;
}

class StillTest : public testing::Test {
 protected:
  StillTest() {
    const auto pressed = press_scene(joint_, joint_->X_JP_default, {0.5e-3, {}});
    press_ = pressed.value().press;
    needle_.shape.length = 50e-3;
  }
  /// The tip `depth` below the pressed face's plane, beside the probe.
  void put(double depth) {
    needle_.X_JN = joint_->X_JP_default * Eigen::Translation3d(4e-3, 11e-3, depth);
  }
  [[nodiscard]] Still lead(NeedleDirection direction) const {
    return lead_to(joint_, press_, Transducer{}, needle_, direction).value();
  }

  std::shared_ptr<const CompiledJoint> joint_ = needled_joint();
  Press press_;
  NeedleView needle_;
};

TEST_F(StillTest, AMembraneThatHoldsIsTentedByWhatASessionThatStopsThereSays) {
  for (const double depth : {0.5e-3, 1e-3}) {
    put(depth);
    const Still still = lead(NeedleDirection::in);
    const Led session = session_says(joint_, press_, needle_.X_JN, true);
    EXPECT_GT(still.needle.force, 0.1) << depth;
    EXPECT_NEAR(still.needle.force, session.force, 0.02 * session.force + 2e-3) << depth;
    EXPECT_EQ(still.needle.region, session.region) << depth;
    EXPECT_NE(still.needle.tented, kOutside) << depth;
    EXPECT_NEAR(still.needle.tissue_moved, session.moved, 0.1 * std::abs(session.moved) + 2e-5)
        << depth;
  }
}

TEST_F(StillTest, ANeedleThatIsInIsDraggedByWhatASessionThatPassesThereSays) {
  put(9e-3);
  const Still still = lead(NeedleDirection::in);
  const Led session = session_says(joint_, press_, needle_.X_JN, false);
  EXPECT_GT(still.needle.force, 0.2);
  EXPECT_NEAR(still.needle.force, session.force, 0.05 * session.force);
  EXPECT_EQ(still.needle.region, session.region);
  EXPECT_EQ(still.needle.tented, kOutside);
  const Still back = lead(NeedleDirection::out);
  EXPECT_LT(back.needle.force, 0);
  EXPECT_LT(back.needle.tissue_moved, still.needle.tissue_moved);
}

TEST_F(StillTest, TheProbeFeelsWhatThePressSays) {
  put(1e-3);
  const Still still = lead(NeedleDirection::in);
  EXPECT_NEAR(still.probe_force, press_.normal_force, 0.05 * press_.normal_force + 5e-3);
  EXPECT_GT(still.share, 0.2);
}

}  // namespace
}  // namespace artus
