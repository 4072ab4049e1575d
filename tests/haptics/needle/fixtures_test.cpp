// SPDX-License-Identifier: AGPL-3.0-or-later
// Laws that act across the needle or on its tip alone: plasticity fixture, god-object, hemisphere.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "artus/detail/haptics/needle/laws/god_object.h"
#include "artus/detail/haptics/needle/laws/hemisphere_workspace.h"
#include "artus/detail/haptics/needle/laws/plasticity_fixture.h"
#include "tests/haptics/needle/tick_builder.h"

namespace artus {
namespace {

using test::AxialTick;
using test::soft;

Eigen::Matrix3d some_rotation() {
  return Eigen::AngleAxisd(0.9, Vec3(1, -2, 0.5).normalized()).toRotationMatrix();
}

class PlasticityTest : public ::testing::TestWithParam<double> {
 protected:
  PlasticityTest() : line(soft(1), GetParam()) {}

  // Moves the tip aside from `from` to `to` at `speed`; returns the force there.
  Vec3 slide(const Vec3& from, const Vec3& to, double speed = 0.002) {
    const int n = std::max(1, static_cast<int>((to - from).norm() / (speed * GetParam())));
    Vec3 force = Vec3::Zero();
    for (int i = 1; i <= n; ++i) {
      line.at(0.02).tip += from + (to - from) * i / n;
      force = law.step(line.tick()).force;
    }
    for (int i = 0; i < 20; ++i) force = law.step(line.tick()).force;  // at rest: no damping left
    return force;
  }

  PlasticityParams params;
  PlasticityFixture law{params};
  AxialTick line;
};

TEST_P(PlasticityTest, IsASpringUpToItsYieldForceThenConstant) {
  EXPECT_NEAR(slide(Vec3::Zero(), Vec3(5e-3, 0, 0)).x(), -params.stiffness * 5e-3, 1e-9);
  EXPECT_NEAR(slide(Vec3(5e-3, 0, 0), Vec3(20e-3, 0, 0)).x(), -params.yield_force, 1e-9);
  // The line has been dragged along to 20 mm - F / K.
  const double place = 20e-3 - params.yield_force / params.stiffness;
  EXPECT_NEAR(slide(Vec3(20e-3, 0, 0), Vec3(10e-3, 0, 0)).x(), params.stiffness * (place - 10e-3),
              1e-3);
}

TEST_P(PlasticityTest, TakesEnergyOverAClosedLoop) {
  double given = 0;
  Vec3 force = Vec3::Zero();
  Vec3 last = Vec3::Zero();
  for (int i = 0; i * GetParam() < 4; ++i) {
    const Vec3 p(25e-3 * std::sin(3.141592653589793 * i * GetParam()), 0, 0);
    given += force.dot(p - last);
    line.at(0.02).tip += p;
    force = law.step(line.tick()).force;
    last = p;
  }
  EXPECT_LT(given, -4 * params.yield_force * 5e-3)
      << "dry friction over two cycles beyond the yield";
}

TEST_P(PlasticityTest, ActsAcrossTheNeedleOnlyWhateverItsDirection) {
  const Eigen::Matrix3d R = some_rotation();
  PlasticityFixture turned(params);
  AxialTick other(soft(1), GetParam());
  other.tick().axis = R * Vec3::UnitZ();
  for (int i = 0; i < 300; ++i) {
    const Vec3 aside(2e-5 * i, -1e-5 * i, 0);
    line.at(0.01 + 1e-5 * i).tip += aside;
    other.at(0.01 + 1e-5 * i).tip += R * aside;
    const Vec3 a = law.step(line.tick()).force;
    const Vec3 b = turned.step(other.tick()).force;
    ASSERT_LT((R * a - b).norm(), 1e-9);
    ASSERT_NEAR(a.z(), 0, 1e-9);
  }
}

INSTANTIATE_TEST_SUITE_P(Periods, PlasticityTest, ::testing::Values(1e-3, 5e-4, 1e-4));

TEST(GodObject, IsASpringAlongTheNormalWhateverTheNeedlesDirection) {
  const GodObjectParams params;
  for (const Vec3& axis : {Vec3(0, 0, 1), Vec3(1, 0, 1), Vec3(-0.4, 0.7, 0.5)}) {
    AxialTick line(soft(1));
    line.tick().axis = axis.normalized();
    line.tick().surface_normal = -Vec3::UnitZ();
    line.at(1e-3).dimple = 1e-3;
    const Vec3 force = GodObject(params).step(line.tick()).force;
    const double below = 1e-3 * axis.normalized().z();
    EXPECT_LT((force - Vec3(0, 0, -params.stiffness * below)).norm(), 1e-12);
  }
}

TEST(GodObject, GivesNothingOffTheSkinOrAfterThePuncture) {
  AxialTick line(soft(1));
  line.tick().surface_normal = -Vec3::UnitZ();
  line.at(-1e-3).dimple = 1e-3;
  EXPECT_EQ(GodObject().step(line.tick()).force.norm(), 0) << "above the surface";
  line.at(1e-3).dimple = 0;
  EXPECT_EQ(GodObject().step(line.tick()).force.norm(), 0) << "punctured";
}

TEST(GodObject, TurnsWithTheBody) {
  const Eigen::Matrix3d R = some_rotation();
  AxialTick line(soft(1));
  AxialTick turned(soft(1));
  line.tick().surface_normal = Vec3(0.2, 0, -1).normalized();
  turned.tick().surface_normal = R * line.tick().surface_normal;
  turned.tick().axis = R * Vec3::UnitZ();
  line.at(2e-3).dimple = 2e-3;
  turned.at(2e-3).dimple = 2e-3;
  const Vec3 force = GodObject().step(line.tick()).force;
  EXPECT_LT((R * force - GodObject().step(turned.tick()).force).norm(), 1e-12);
}

TEST(HemisphereWorkspace, PushesOutWithConstantForceInsideAndNoneOutside) {
  const HemisphereParams params{Vec3(0.1, -0.2, 0.3), 0.15, 2.5};
  HemisphereWorkspace law(params);
  AxialTick line(soft(1));
  const Vec3 out = Vec3(1, 2, -2).normalized();
  for (const double distance : {1e-6, 0.05, 0.1499}) {
    line.at(0).tip = params.centre + distance * out;
    EXPECT_LT((law.step(line.tick()).force - 2.5 * out).norm(), 1e-9) << distance;
  }
  line.at(0).tip = params.centre + 0.1501 * out;
  EXPECT_EQ(law.step(line.tick()).force.norm(), 0);
  line.at(0).tip = params.centre;
  EXPECT_EQ(law.step(line.tick()).force.norm(), 0) << "no direction at the centre";
}

}  // namespace
}  // namespace artus
