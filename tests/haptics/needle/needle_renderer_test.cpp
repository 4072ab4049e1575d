// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/haptics/needle_renderer.h"

#include <cmath>
#include <limits>
#include <mutex>

#include <gtest/gtest.h>

#include "tests/haptics/needle/block_stroke.h"
#include "tests/support/real_time.h"

namespace artus {
namespace {

NeedleRenderer make_renderer(const std::shared_ptr<const Scene>& scene, double rate = 1000) {
  NeedleRendererParams params;
  params.device = find_device("virtuose_6d_desktop").value();
  params.rate_hz = rate;
  return {scene, make_layer_table(scene->joint()), params};
}

TEST(NeedleRenderer, TickNeverAllocatesOrLocks) {
  const auto scene = test::block();
  NeedleRenderer renderer = make_renderer(scene);
  ARTUS_RUNS_REALTIME(NeedleRenderer::take, renderer.take({}));
  bool touched_bone = false;
  for (int i = 0; i < 5000; ++i) {
    TimedPose pose = test::stroke(1e-3 * i);
    if (i == 2500) pose.X_JN.translation().x() = std::numeric_limits<double>::quiet_NaN();
    ARTUS_RUNS_REALTIME(NeedleRenderer::step, renderer.step(pose));
    touched_bone = touched_bone || renderer.model().contact().state() == ContactState::bone;
  }
  EXPECT_TRUE(touched_bone);
}

TEST(LockCounter, SeesALock) {
  if (!test::LockCounter::supported()) GTEST_SKIP() << "the sanitizer owns the locks";
  std::mutex mutex;
  const test::LockCounter locks;
  { const std::lock_guard<std::mutex> lock(mutex); }
  EXPECT_EQ(locks.count(), 1);
}

TEST(NeedleRenderer, SamePosesGiveTheSameBytes) {
  const auto scene = test::block();
  NeedleRenderer a = make_renderer(scene);
  NeedleRenderer b = make_renderer(scene);
  for (int i = 0; i < 3000; ++i) {
    const Vec3 fa = a.step(test::stroke(1e-3 * i)).command.force;
    const Vec3 fb = b.step(test::stroke(1e-3 * i)).command.force;
    ASSERT_EQ(fa, fb);
  }
}

TEST(NeedleRenderer, BodyAndNeedleMovedTogetherGiveTheRotatedForce) {
  Pose X = Pose::Identity();
  X.linear() = Eigen::AngleAxisd(1.1, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  X.translation() = Vec3(0.1, -0.2, 0.3);
  const auto scene = test::block();
  const auto moved = test::block(X);
  NeedleRenderer a = make_renderer(scene);
  NeedleRenderer b = make_renderer(moved);
  double top = 0;
  for (int i = 0; i < 3000; ++i) {
    const TimedPose pose = test::stroke(1e-3 * i);
    const Wrench wa = a.step(pose).command;
    const Wrench wb = b.step({X * pose.X_JN, pose.time}).command;
    ASSERT_LT((X.linear() * wa.force - wb.force).norm(), 2e-3) << i;  // float depths
    top = std::max(top, wa.force.norm());
  }
  EXPECT_GT(top, 2);
}

}  // namespace
}  // namespace artus
