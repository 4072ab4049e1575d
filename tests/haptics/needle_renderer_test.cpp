// SPDX-License-Identifier: AGPL-3.0-or-later
#include "haptics/needle_renderer.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "core/noise.h"
#include "tests/support/layered_body.h"
#include "tests/support/no_alloc.h"

namespace artus {
namespace {

std::shared_ptr<const Scene> block(const Pose& X = Pose::Identity()) {
  const std::vector<test::FlatLayer> layers{{"skin", 0.003},      {"muscle", 0.015},
                                            {"bursa", 0.003},     {"tendon", 0.005},
                                            {"cartilage", 0.003}, {"bone", 0.02}};
  return std::make_shared<const Scene>(std::make_shared<const CompiledJoint>(
      test::transformed(test::make_layered_block(layers, 0.2, 0.2), X)));
}

NeedleRenderer make_renderer(const std::shared_ptr<const Scene>& scene, double rate = 1000) {
  return {scene,         LayerTable(scene->joint(), {}, {}),         NeedleParams{},
          GuardParams{}, find_device("virtuose_6d_desktop").value(), rate};
}

TimedPose stroke(double t) {
  // 0.3 s outside, in to 33 mm (bone at 29 mm) and out, with a little sideways motion.
  const double z = -0.005 + 0.038 * 0.5 * (1 - std::cos(3.0 * std::max(0.0, t - 0.3)));
  return {
      make_pose(Vec3(1e-3 * std::sin(5 * t), 0, z), Vec3(0.05 * std::sin(t), 0, 1), Vec3::UnitX()),
      t};
}

TEST(NeedleRenderer, TickNeverAllocates) {
  if (!test::AllocationCounter::supported()) GTEST_SKIP() << "the sanitizer owns malloc";
  const auto scene = block();
  NeedleRenderer renderer = make_renderer(scene);
  const NeedleParams params;
  bool touched_bone = false;
  test::AllocationCounter counter;
  for (int i = 0; i < 5000; ++i) {
    const auto& out = renderer.step(stroke(1e-3 * i));
    touched_bone = touched_bone || renderer.model().contact().state() == ContactState::bone;
    if (i == 2500) {
      TimedPose bad = stroke(1e-3 * i);
      bad.X_JN.translation().x() = std::numeric_limits<double>::quiet_NaN();
      renderer.step(bad);
    }
    ASSERT_TRUE(out.command.force.allFinite());
  }
  const long count = counter.count();
  EXPECT_EQ(count, 0);
  EXPECT_TRUE(touched_bone);
}

TEST(NeedleRenderer, SamePosesGiveTheSameBytes) {
  const auto scene = block();
  NeedleRenderer a = make_renderer(scene);
  NeedleRenderer b = make_renderer(scene);
  for (int i = 0; i < 3000; ++i) {
    const Vec3 fa = a.step(stroke(1e-3 * i)).command.force;
    const Vec3 fb = b.step(stroke(1e-3 * i)).command.force;
    ASSERT_EQ(fa, fb);
  }
}

TEST(NeedleRenderer, BodyAndNeedleMovedTogetherGiveTheRotatedForce) {
  Pose X = Pose::Identity();
  X.linear() = Eigen::AngleAxisd(1.1, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  X.translation() = Vec3(0.1, -0.2, 0.3);
  const auto scene = block();
  const auto moved = block(X);
  NeedleRenderer a = make_renderer(scene);
  NeedleRenderer b = make_renderer(moved);
  double top = 0;
  for (int i = 0; i < 3000; ++i) {
    const TimedPose pose = stroke(1e-3 * i);
    const Wrench wa = a.step(pose).command;
    const Wrench wb = b.step({X * pose.X_JN, pose.time}).command;
    ASSERT_LT((X.linear() * wa.force - wb.force).norm(), 2e-3) << i;  // float depths
    top = std::max(top, wa.force.norm());
  }
  EXPECT_GT(top, 2);
}

// What a broken device can send: NaN, infinite, teleport, frozen, reversed time, out of workspace.
TimedPose garbage(std::uint64_t seed, std::uint64_t i, const TimedPose& sane) {
  TimedPose pose = sane;
  const double kind = uniform_noise(seed, i);
  const auto axis = static_cast<Eigen::Index>(i % 3);
  if (kind < 0.01)
    pose.X_JN.translation()[axis] = std::numeric_limits<double>::quiet_NaN();
  else if (kind < 0.02)
    pose.X_JN.linear()(axis, 0) = -std::numeric_limits<double>::infinity();
  else if (kind < 0.03)
    pose.X_JN.translation() += Vec3::Constant(normal_noise(seed + 1, i));
  else if (kind < 0.04)
    pose.time -= 1;
  else if (kind < 0.05)
    pose.X_JN.translation()[axis] = 1e300;
  else if (kind < 0.06)
    pose.X_JN.linear() *= 2;
  else if (kind < 0.07)
    pose.time = std::numeric_limits<double>::quiet_NaN();
  return pose;
}

TEST(NeedleRenderer, GarbagePosesNeverGetAnUnsafeForceOut) {
  const auto scene = block();
  GuardParams guard;
  guard.workspace_half = Vec3::Constant(0.25);
  const DeviceLimits device = find_device("virtuose_6d_desktop").value();
  NeedleRenderer renderer(scene, LayerTable(scene->joint(), {}, {}), NeedleParams{}, guard, device,
                          1000);
  Vec3 last = Vec3::Zero();
  long faults = 0;
  long felt = 0;
  for (std::uint64_t i = 0; i < 100000; ++i) {
    const double t = 1e-3 * static_cast<double>(i);
    // Long sane stretches between bursts of garbage, so that forces come back by the ramp.
    const bool burst = i % 2000 > 1800;
    const TimedPose pose = burst ? garbage(5, i, stroke(t)) : stroke(t);
    const RenderedNeedle& out = renderer.step(pose);
    ASSERT_TRUE(out.command.force.allFinite() && out.command.torque.allFinite()) << i;
    ASSERT_LE(out.command.force.norm(), device.force * (1 + 1e-12));
    ASSERT_LE(out.command.torque.norm(), device.torque * (1 + 1e-12));
    if ((out.status & TickStatus::kFaults) != 0) {
      ++faults;
      ASSERT_EQ(out.command.force.norm(), 0) << "zero within the tick of the fault";
    } else {
      ASSERT_LE((out.command.force - last).norm(), guard.force_slew * 1e-3 * (1 + 1e-9));
    }
    if (out.command.force.norm() > 0.5) ++felt;
    last = out.command.force;
  }
  EXPECT_GT(faults, 500);
  EXPECT_GT(felt, 10000) << "it recovers";
}

}  // namespace
}  // namespace artus
