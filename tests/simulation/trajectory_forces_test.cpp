// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/simulation/trajectory_forces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include <gtest/gtest.h>

#include "artus/detail/simulation/records.h"
#include "artus/haptics/needle_renderer.h"
#include "tests/support/layered_body.h"

namespace artus {
namespace {

std::shared_ptr<const Scene> make_scene() {
  const std::array<FlatLayer, 3> layers{{{"skin", 2e-3}, {"muscle", 20e-3}, {"bone", 10e-3}}};
  return std::make_shared<const Scene>(
      std::make_shared<const CompiledJoint>(test::make_layered_block(layers, 0.1, 0.1)));
}

std::vector<TrajectoryPose> alone(const std::vector<Pose>& needles) {
  std::vector<TrajectoryPose> poses;
  for (const Pose& X_JN : needles) poses.push_back({X_JN, {}});
  return poses;
}

SessionParams params_of(const char* device = "ideal") {
  return trajectory_params(*make_scene(), device, 1000, true).value();
}

TEST(TrajectoryForces, AStraightInsertionGoesThereAndBackInEvenSteps) {
  const Vec3 entry(0.01, 0, 0);
  const Vec3 target(0.01, 0, 0.015);
  const auto poses = straight_insertion(entry, target, 0.02, 1000, 5e-3);
  EXPECT_EQ(poses.size(), 2 * 1000 + 1U);  // 20 mm at 20 mm/s, twice
  EXPECT_NEAR(poses.front().translation().z(), -5e-3, 1e-12);
  EXPECT_NEAR(poses.back().translation().z(), -5e-3, 1e-12);
  for (std::size_t i = 1; i < poses.size(); ++i)
    EXPECT_LE((poses[i].translation() - poses[i - 1].translation()).norm(), 20e-6 + 1e-12);
  const auto deepest = std::max_element(
      poses.begin(), poses.end(),
      [](const Pose& a, const Pose& b) { return a.translation().z() < b.translation().z(); });
  EXPECT_NEAR(deepest->translation().z(), 0.015, 1e-12);
}

TEST(TrajectoryForces, AreThoseOfTheTickThatASessionRuns) {
  const auto scene = make_scene();
  const auto poses = straight_insertion(Vec3::Zero(), Vec3(0, 0, 0.012), 0.05, 1000);
  const auto forces = compute_trajectory_forces(scene, alone(poses), params_of("touch"));
  ASSERT_TRUE(forces) << forces.error().to_string();
  ASSERT_EQ(forces->size(), poses.size());
  const auto renderer = make_needle_renderer(scene, "touch", 1000);
  ASSERT_TRUE(renderer);
  double most = 0;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const RenderedNeedle& tick = (*renderer)->step({poses[i], static_cast<double>(i) / 1000});
    EXPECT_LT(((*forces)[i].force - tick.command.force).norm(), 1e-6) << i;
    most = std::max(most, (*forces)[i].axial);
  }
  EXPECT_GT(most, 0.1);  // against the insertion
}

TEST(TrajectoryForces, ThereIsNoForceInTheAirAndAPoseThatIsNoneSaysSo) {
  std::vector<Pose> poses(50, make_pose(Vec3(0, 0, -0.05), Vec3::UnitZ(), Vec3::UnitX()));
  poses[20].translation().x() = std::nan("");
  const auto forces = compute_trajectory_forces(make_scene(), alone(poses), params_of());
  ASSERT_TRUE(forces);
  for (const TrajectoryForce& tick : *forces) EXPECT_EQ(tick.force.norm(), 0);
  EXPECT_EQ((*forces)[19].status & TickStatus::kFaults, 0U);
  EXPECT_NE((*forces)[20].status & SessionStatus::kPeerInvalid, 0U);
}

TEST(TrajectoryForces, AnUnknownDeviceAndRateAreRefused) {
  EXPECT_FALSE(trajectory_params(*make_scene(), "hammer", 1000, true));
  EXPECT_FALSE(trajectory_params(*make_scene(), "ideal", 1, true));
}

}  // namespace
}  // namespace artus
