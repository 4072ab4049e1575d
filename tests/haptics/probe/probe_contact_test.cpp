// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/haptics/probe/probe_contact.h"

#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "artus/detail/core/units.h"
#include "tests/support/layered_body.h"
#include "tests/support/no_alloc.h"

namespace artus {
namespace {

constexpr double kArea = 0.040 * 0.006;  // m^2

std::shared_ptr<const Scene> make_block(std::span<const test::FlatLayer> layers,
                                        double width = 0.2) {
  return std::make_shared<const Scene>(std::make_shared<const CompiledJoint>(
      test::make_layered_block(layers, width, 0.2, Vec3(0.01, -0.02, 0.03))));
}

/// The probe on top of such a block, pushed in by `indentation` and tilted about its y axis.
Pose on_block(double indentation, double tilt = 0, const Vec3& shift = Vec3::Zero()) {
  Pose pose = make_pose(Vec3(0.01, -0.02, 0.03) + shift + indentation * Vec3::UnitZ(),
                        Vec3::UnitZ(), Vec3::UnitX());
  pose.rotate(Eigen::AngleAxisd(tilt, Vec3::UnitY()));
  return pose;
}

const std::array<test::FlatLayer, 1> kMuscle{{{"muscle", 0.03}}};
const std::array<test::FlatLayer, 4> kSoft{
    {{"skin", 0.002}, {"fat", 0.005}, {"muscle", 0.023}, {"bone", 0.01}}};
const std::array<test::FlatLayer, 2> kThin{{{"muscle", 0.003}, {"bone", 0.02}}};
const std::array<test::FlatLayer, 2> kThick{{{"muscle", 0.03}, {"bone", 0.02}}};

TEST(ProbeContactColumn, SmallStrainIsASeriesOfSprings) {
  const std::array<ColumnLayer, 3> layers{{{0.002, 1e5}, {0.005, 3e3}, {0.02, 15e3}}};
  const double compliance = 0.002 / 1e5 + 0.005 / 3e3 + 0.02 / 15e3;
  const ColumnResponse r = compress_column({}, layers, 1e-7);
  EXPECT_NEAR(r.pressure, 1e-7 / compliance, 1e-3 * r.pressure);
  EXPECT_NEAR(r.stiffness, 1 / compliance, 1e-3 * r.stiffness);
}

TEST(ProbeContactColumn, OneLayerFollowsItsClosedFormUpToTheStrainLimit) {
  ColumnParams params;
  params.stop_stiffness = 1e18;  // the layer alone
  const std::array<ColumnLayer, 1> layer{{{0.03, 15e3}}};
  for (const double strain : {0.01, 0.1, 0.3, 0.5, 0.59}) {
    const double expected = 15e3 * strain / (1 - strain / params.strain_limit);
    EXPECT_NEAR(compress_column(params, layer, 0.03 * strain).pressure, expected, 0.01 * expected);
  }
}

TEST(ProbeContactColumn, StiffnessIsTheSlopeOfThePressure) {
  const std::array<ColumnLayer, 2> layers{{{0.002, 1e5}, {0.005, 3e3}}};
  for (const double depth : {1e-4, 1e-3, 3e-3, 4.1e-3, 4.5e-3, 1e-2}) {
    const double h = 1e-8;
    const double slope = (compress_column({}, layers, depth + h).pressure -
                          compress_column({}, layers, depth - h).pressure) /
                         (2 * h);
    EXPECT_NEAR(compress_column({}, layers, depth).stiffness, slope, 1e-4 * slope) << depth;
  }
}

TEST(ProbeContactColumn, EnergyIsTheIntegralOfThePressure) {
  const std::array<ColumnLayer, 2> layers{{{0.002, 1e5}, {0.005, 3e3}}};
  for (const double depth : {1e-6, 1e-4, 1e-3, 3e-3, 4.1e-3}) {
    double work = 0;
    constexpr int kSteps = 20000;
    for (int i = 0; i < kSteps; ++i) {
      work += compress_column({}, layers, depth * (i + 0.5) / kSteps).pressure * depth / kSteps;
    }
    EXPECT_NEAR(compress_column({}, layers, depth).energy, work, 1e-6 * work) << depth;
  }
}

TEST(ProbeContactColumn, WithoutTissueOnlyTheStopAnswers) {
  const ColumnParams params;
  EXPECT_NEAR(compress_column(params, {}, 1e-5).pressure, 1e-5 * params.stop_stiffness, 1e-6);
  EXPECT_EQ(compress_column(params, {}, 0).pressure, 0);
  EXPECT_EQ(compress_column(params, {}, -1).pressure, 0);
}

TEST(ProbeContact, ForceOnASoftBlockIsTheSeriesSpringsWithinOnePercent) {
  ProbeContactModel model(make_block(kSoft), {});
  const double indentation = 2e-5;
  const double stiffness = kArea / (0.002 / 1e5 + 0.005 / 3e3 + 0.023 / 15e3);
  const ProbeContact& contact = model.step(on_block(indentation));
  EXPECT_NEAR(contact.normal_force, stiffness * indentation, 0.01 * stiffness * indentation);
  EXPECT_NEAR(contact.stiffness, stiffness, 0.01 * stiffness);
  EXPECT_NEAR(contact.wrench.force.z(), -contact.normal_force, 1e-12);
  EXPECT_NEAR(contact.wrench.torque.norm(), 0, 1e-9);
  EXPECT_DOUBLE_EQ(contact.contact_share, 1);
}

TEST(ProbeContact, BoneUnderThreeMillimetresIsTenTimesStifferThanThreeCentimetresOfMuscle) {
  ProbeContactModel thin(make_block(kThin), {});
  ProbeContactModel thick(make_block(kThick), {});
  for (const double push : {0.5e-3, 1e-3, 1.5e-3}) {
    const double over_bone = thin.step(on_block(push)).stiffness;
    const double over_muscle = thick.step(on_block(push)).stiffness;
    EXPECT_GT(over_bone, 10 * over_muscle) << push;
  }
}

TEST(ProbeContact, StiffnessIsTheSlopeOfTheNormalForce) {
  ProbeContactModel model(make_block(kSoft), {});
  const double h = 1e-6;
  const double above = model.step(on_block(4e-3 + h)).normal_force;
  const double below = model.step(on_block(4e-3 - h)).normal_force;
  EXPECT_NEAR(model.step(on_block(4e-3)).stiffness, (above - below) / (2 * h),
              1e-3 * (above - below) / (2 * h));
}

TEST(ProbeContact, OffTheSkinEverythingIsExactlyZero) {
  ProbeContactModel model(make_block(kSoft), {});
  static_cast<void>(model.step(on_block(2e-3)));
  const ProbeContact& contact = model.step(on_block(-1e-3));
  EXPECT_EQ(contact.wrench.force, Vec3::Zero());
  EXPECT_EQ(contact.wrench.torque, Vec3::Zero());
  EXPECT_EQ(contact.stiffness, 0);
  for (const float c : model.coverage()) EXPECT_EQ(c, 0);
}

TEST(ProbeContact, TiltTurnsTheHandBackWithTheTorqueOfALinearPressure) {
  // Pressure k (d - x sin tilt): the force stays, the moment about y is k L^3 W / 12 sin tilt.
  ProbeContactModel model(make_block(kMuscle), {});
  const double tilt = 1e-4;
  const double base = 15e3 / 0.03;
  const ProbeContact& contact = model.step(on_block(1e-5, tilt));
  const double torque = base * std::pow(0.040, 3) * 0.006 / 12 * tilt;
  // A positive turn about y lifts the +x end, so the -x end presses and turns the hand back.
  EXPECT_NEAR(contact.wrench.torque.y(), -torque, 0.02 * torque);
  EXPECT_NEAR(contact.wrench.torque.x(), 0, 1e-3 * torque);
}

TEST(ProbeContact, WithoutFrictionTheForceOnASlopeStandsOnTheSkin) {
  ProbeContactParams params;
  params.gel_friction = 0;
  params.footprint.columns_y = 1;
  ProbeContactModel model(make_block(kMuscle), params);
  // 0.2 mm deep: the whole face presses at 0.2 degrees, a third of it at 2 degrees.
  for (const double tilt : {0.2 * kDegree, 2 * kDegree, -2 * kDegree}) {
    const ProbeContact& contact = model.step(on_block(2e-4, tilt));
    ASSERT_GT(contact.normal_force, 0);
    EXPECT_NEAR(contact.wrench.force.x(), 0, 0.03 * std::abs(std::tan(tilt)) * contact.normal_force)
        << tilt;
    EXPECT_LT(contact.wrench.force.z(), 0);
  }
}

/// A closed way of the face: place (m) and tilt about y (rad) at a phase.
struct Path {
  Vec3 (*place)(double phase);
  double (*tilt)(double phase);
};

/// Energy given to the hand on a closed way over a bone that lies askew below, and what it would be
/// with the normal pressure alone, as shares of the work done to and fro.
struct LoopEnergy {
  double all = 0;
  double pressure_alone = 0;
};

LoopEnergy ride_over_bone(const ProbeContactParams& params, const Path& path, double turn) {
  ProbeContactModel model(
      std::make_shared<const Scene>(std::make_shared<const CompiledJoint>(
          test::make_block_with_sphere({"muscle", Vec3(0.16, 0.1, 0.1), Vec3::Zero(), "bone",
                                        Vec3(0.01, 0.01, 0.05), 0.04}))),
      params);
  LoopEnergy energy;
  double to_and_fro = 0;
  Vec3 position = Vec3::Zero();
  double tilt = 0;
  Wrench felt;
  Wrench pressed;
  constexpr int kSteps = 4000;
  for (int i = 0; i <= kSteps; ++i) {
    const double phase = turn * 2 * std::numbers::pi * i / kSteps;
    Pose pose = make_pose(path.place(phase), Vec3::UnitZ(), Vec3::UnitX());
    pose.rotate(Eigen::AngleAxisd(path.tilt(phase), Vec3::UnitY()));
    const ProbeContact& contact = model.step(pose);
    Wrench pressure;
    pressure.force = -contact.normal_force * pose.linear().col(2);
    pressure.torque = contact.wrench.torque - contact.turning;
    if (i > 0) {
      const auto work = [&](const Wrench& before, const Wrench& now) {
        return 0.5 * (before.force + now.force).dot(pose.translation() - position) +
               0.5 * (before.torque.y() + now.torque.y()) * (path.tilt(phase) - tilt);
      };
      energy.all += work(felt, contact.wrench);
      energy.pressure_alone += work(pressed, pressure);
      to_and_fro += std::abs(work(felt, contact.wrench));
    }
    position = pose.translation();
    tilt = path.tilt(phase);
    felt = contact.wrench;
    pressed = pressure;
  }
  return {energy.all / to_and_fro, energy.pressure_alone / to_and_fro};
}

constexpr Path kSliding{[](double phase) {
                          return Vec3(0.012 * std::sin(phase), 0.004 * std::sin(phase),
                                      3e-3 + 3.5e-3 * std::cos(phase));
                        },
                        [](double) {
                          return 0.0;
                        }};
constexpr Path kTilting{[](double phase) { return Vec3(-0.008, 0, 5e-3 + 3e-3 * std::cos(phase)); },
                        [](double phase) {
                          return 0.2 + 0.2 * std::sin(phase);
                        }};

TEST(ProbeContact, ClosedWaysOverUnevenTissueGiveTheHandNoEnergy) {
  ProbeContactParams params;
  params.gel_friction = 0;
  for (const Path& path : {kSliding, kTilting}) {
    for (const double turn : {1.0, -1.0}) {
      params.footprint.columns_y = 3;
      const LoopEnergy coarse = ride_over_bone(params, path, turn);
      EXPECT_LT(std::abs(coarse.all), 0.025) << turn;
      EXPECT_GT(std::abs(coarse.pressure_alone), 0.1) << "the way must tell the two apart";
      params.footprint.columns_y = 12;
      EXPECT_LT(std::abs(ride_over_bone(params, path, turn).all), 0.005) << turn;
    }
  }
}

TEST(ProbeContact, SlidingMeetsCoulombFrictionAgainstTheMotion) {
  for (const bool gel : {true, false}) {
    ProbeContactParams params;
    params.gel = gel;
    ProbeContactModel model(make_block(kMuscle), params);
    const Vec3 direction = Vec3(0.6, -0.8, 0);
    ProbeContact contact;
    for (int i = 0; i <= 400; ++i) {
      contact = model.step(on_block(2e-3, 0, i * 1e-4 * direction));
    }
    const double coefficient = gel ? params.gel_friction : params.dry_friction;
    const Vec3 tangential(contact.wrench.force.x(), contact.wrench.force.y(), 0);
    EXPECT_NEAR(tangential.norm(), coefficient * contact.normal_force, 1e-6 * contact.normal_force);
    EXPECT_NEAR(tangential.normalized().dot(direction), -1, 1e-9);
  }
}

TEST(ProbeContact, SkinSticksBeforeItSlips) {
  ProbeContactParams params;
  params.gel = false;
  ProbeContactModel model(make_block(kMuscle), params);
  static_cast<void>(model.step(on_block(5e-3)));
  const double shift = 1e-5;
  const ProbeContact& contact = model.step(on_block(5e-3, 0, Vec3(shift, 0, 0)));
  EXPECT_NEAR(contact.wrench.force.x(), -params.shear_stiffness * shift, 1e-9);
}

TEST(ProbeContact, MaskEndsWhereTheBodyEnds) {
  ProbeContactModel model(make_block(kMuscle, 0.06), {});
  // The block ends at +30 mm; the face is moved by 25 mm, so elements beyond +5 mm hang in air.
  static_cast<void>(model.step(on_block(1e-3, 0, Vec3(0.025, 0, 0))));
  const auto coverage = model.coverage();
  for (std::size_t e = 0; e < coverage.size(); ++e) {
    const double x = 0.040 * ((static_cast<double>(e) + 0.5) / 128 - 0.5);
    if (std::abs(x - 0.005) < 0.001) continue;  // half a column
    EXPECT_EQ(coverage[e], x < 0.005 ? 1.0F : 0.0F) << x;
  }
}

TEST(ProbeContact, MaskOfATiltedProbeEndsWhereTheFaceLeavesTheSkin) {
  ProbeContactParams params;
  params.gel = false;
  ProbeContactModel model(make_block(kMuscle), params);
  const double tilt = 2 * kDegree;
  const double edge = 0.006;  // m along x where the face crosses the skin
  static_cast<void>(model.step(on_block(edge * std::sin(tilt), tilt)));
  const auto coverage = model.coverage();
  for (std::size_t e = 0; e < coverage.size(); ++e) {
    const double x = 0.040 * ((static_cast<double>(e) + 0.5) / 128 - 0.5);
    if (std::abs(x - edge) < 0.0002) continue;  // half an element
    EXPECT_EQ(coverage[e], x < edge ? 1.0F : 0.0F) << x;
  }
}

TEST(ProbeContact, GelBridgesAThinGap) {
  for (const bool gel : {true, false}) {
    ProbeContactParams params;
    params.gel = gel;
    ProbeContactModel model(make_block(kMuscle), params);
    const ProbeContact& contact = model.step(on_block(-0.3e-3));
    EXPECT_EQ(contact.normal_force, 0);
    for (const float c : model.coverage()) EXPECT_EQ(c, gel ? 1.0F : 0.0F);
  }
}

TEST(ProbeContact, RigidMotionOfBodyAndProbeTurnsTheWrenchAlong) {
  const CompiledJoint joint = test::make_layered_block(kSoft, 0.2, 0.2, Vec3(0.01, -0.02, 0.03));
  const Pose X = make_pose(Vec3(0.3, -0.1, 1.2), Vec3(1, 2, -0.5), Vec3(0, 1, 1));
  ProbeContactModel here(make_block(kSoft), {});
  ProbeContactModel there(std::make_shared<const Scene>(
                              std::make_shared<const CompiledJoint>(test::transformed(joint, X))),
                          {});
  for (int i = 0; i < 5; ++i) {
    const Pose pose = on_block(3e-3, 0.05, Vec3(i * 1e-3, 0, 0));
    const ProbeContact& a = here.step(pose);
    const ProbeContact& b = there.step(X * pose);
    EXPECT_NEAR((X.linear() * a.wrench.force - b.wrench.force).norm(), 0, 1e-6);
    EXPECT_NEAR((X.linear() * a.wrench.torque - b.wrench.torque).norm(), 0, 1e-7);
  }
}

TEST(ProbeContact, PoseThatIsNotFiniteOrRigidGivesNoForceAndSaysSo) {
  ProbeContactModel model(make_block(kSoft), {});
  Pose pose = on_block(2e-3);
  pose.translation().x() = std::numeric_limits<double>::quiet_NaN();
  const ProbeContact& broken = model.step(pose);
  EXPECT_EQ(broken.status, TickStatus::kNotFinite);
  EXPECT_EQ(broken.wrench.force, Vec3::Zero());
  pose = on_block(2e-3);
  pose.linear() *= 1.1;
  EXPECT_EQ(model.step(pose).status, TickStatus::kNotRigid);
  EXPECT_EQ(model.step(on_block(2e-3)).status, TickStatus::kOk);
}

TEST(ProbeContact, TickAllocatesNothing) {
  if (!test::AllocationCounter::supported()) GTEST_SKIP() << "sanitizer build";
  ProbeContactModel model(make_block(kSoft), {});
  static_cast<void>(model.step(on_block(1e-3)));
  long count = -1;
  {
    const test::AllocationCounter counter;
    for (int i = 0; i < 50; ++i) {
      static_cast<void>(model.step(on_block(i * 1e-4 - 1e-3, 0.01 * i)));
    }
    count = counter.count();
  }
  EXPECT_EQ(count, 0);
}

}  // namespace
}  // namespace artus
