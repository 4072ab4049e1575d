// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/haptics/probe/skin_contact.h"

#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "artus/detail/haptics/probe/curve_fit.h"
#include "artus/detail/haptics/probe/probe_packet.h"
#include "artus/detail/haptics/probe/skin_surface.h"
#include "tests/support/real_time.h"

namespace artus {
namespace {

constexpr double kStiffness = 154;  // N/m
constexpr double kHardening = 200;  // 1/m
constexpr double kGain = 1 + 1 + 0.6;

/// The frame of the skin: tilted in J, so that no axis is taken for another.
Pose skin_frame() {
  return make_pose(Vec3(0.1, 0.2, 0.3), Vec3(1, 2, 2).normalized(), Vec3(2, 1, -2).normalized());
}

/// Skin whose height is `height(x, y)`, m, seen by a face `above` it.
template <class Height>
ProbePacket packet_of(std::uint64_t number, Height height, double stiffness = kStiffness) {
  ProbePacket packet;
  packet.number = number;
  const Pose X_JF = skin_frame();
  for (Eigen::Index i = 0; i < 12; ++i)
    packet.X_JF[static_cast<std::size_t>(i)] = X_JF.matrix()(i / 4, i % 4);
  packet.length = 0.04;
  packet.width = 0.006;
  packet.spacing_x = 5e-3;
  packet.spacing_y = 26e-3 / 6;
  for (std::size_t j = 0; j < ProbePacket::kRows; ++j)
    for (std::size_t i = 0; i < ProbePacket::kColumns; ++i)
      packet.z[i + ProbePacket::kColumns * j] =
          height((static_cast<double>(i) - 6) * 5e-3, (static_cast<double>(j) - 3) * 26e-3 / 6);
  packet.curve = {stiffness, kHardening, 0, 0};
  return packet;
}
ProbePacket flat(std::uint64_t number = 1, double stiffness = kStiffness) {
  return packet_of(
      number, [](double, double) { return 0.0; }, stiffness);
}

/// A face `depth` below flat skin, `x` along it, turned by `turn` rad about its y.
Pose pressed(double depth, double x = 0, double turn = 0) {
  Pose X_FP = Pose::Identity();
  X_FP.translation() = Vec3(x, 0, depth);
  X_FP.rotate(Eigen::AngleAxisd(turn, Vec3::UnitY()));
  return skin_frame() * X_FP;
}

double force_at(double depth) {
  return kStiffness / kHardening * (std::exp(kHardening * depth) - 1);
}

/// The force out of the body.
double normal(const Wrench& wrench) {
  return -wrench.force.dot(skin_frame().linear().col(2));
}

class Touch {
 public:
  explicit Touch(const SkinContactParams& params = {}) : contact_(params) {}
  void take(const ProbePacket& packet) {
    ProbePacket now = packet;
    now.tick = tick_;
    contact_.take(now);
  }
  const Wrench& at(const Pose& X_JP) { return contact_.step(X_JP, ++tick_); }
  double rest(const Pose& X_JP, int ticks = 1000) {
    for (int i = 0; i < ticks; ++i) {
      if (i % 50 == 0) take(last_);
      at(X_JP);
    }
    return normal(at(X_JP));
  }
  /// What rest() hears from the tissue; the first time from the air.
  void keep(const ProbePacket& packet) {
    last_ = packet;
    take(packet);
    if (tick_ == 0) at(pressed(-1e-3));
  }
  SkinContact& contact() { return contact_; }
  std::uint64_t tick() const { return tick_; }

 private:
  SkinContact contact_;
  ProbePacket last_;
  std::uint64_t tick_ = 0;
};

TEST(SkinContact, ComesToRestOnTheCurveOfItsPacket) {
  Touch touch;
  touch.keep(flat());
  for (const double depth : {0.5e-3, 2e-3, 6e-3})
    EXPECT_NEAR(touch.rest(pressed(depth)), force_at(depth), 1e-6 * force_at(depth)) << depth;
  EXPECT_EQ(touch.contact().share(), 1);
}

TEST(SkinContact, IsStifferByItsArmsAtOnceAndForgetsThemInTheirTime) {
  Touch touch;
  touch.keep(flat());
  EXPECT_NEAR(normal(touch.at(pressed(1e-3))), kGain * force_at(1e-3), 1e-9);
  for (int i = 1; i < 50; ++i) touch.at(pressed(1e-3));
  const double fast = 0.6 * std::exp(-50 / 6.0);
  EXPECT_NEAR(normal(touch.at(pressed(1e-3))), (1 + std::exp(-1.0) + fast) * force_at(1e-3), 1e-9);
}

TEST(SkinContact, AFaceThatComesFromNowhereIntoTheTissueIsFeltByARamp) {
  Touch touch;
  touch.take(flat());
  double last = normal(touch.at(pressed(6e-3)));
  EXPECT_LT(last, 0.06);
  double largest = 0;
  for (int i = 0; i < 1500; ++i) {
    if (i % 50 == 0) touch.take(flat());
    const double now = normal(touch.at(pressed(6e-3)));
    largest = std::max(largest, now - last);
    last = now;
  }
  EXPECT_LT(largest, 20e-3 * kGain) << "N a tick";
  EXPECT_NEAR(last, force_at(6e-3), 0.01 * last);
  touch.contact().step(std::nullopt, touch.tick());
  EXPECT_LT(normal(touch.at(pressed(6e-3))), 0.06) << "after a pause the same";
}

TEST(SkinContact, TouchesNothingOffTheSkinHoweverFastItIsLeft) {
  Touch touch;
  touch.keep(flat());
  EXPECT_GT(touch.rest(pressed(5e-3)), 1);
  EXPECT_EQ(touch.at(pressed(-1e-6)).force, Vec3::Zero());
  EXPECT_EQ(touch.contact().share(), 0);
  EXPECT_EQ(touch.contact().step(std::nullopt, touch.tick()).force, Vec3::Zero());
}

TEST(SkinContact, IsMetInTheTickThatMeetsTheSkinAtAnySpeed) {
  Touch touch;
  touch.keep(flat());
  for (int i = 0; i < 20; ++i) touch.at(pressed(-4e-3 + 0.2e-3 * i));
  EXPECT_GT(normal(touch.at(pressed(0.2e-3))), kGain * force_at(0.19e-3));
}

/// The elastic part alone is the gradient of one energy, on bent skin, with a tilted face and
/// stiffness that changes along it.
TEST(SkinContact, ForceAndTorqueAtRestAreTheGradientOfOneEnergy) {
  ProbePacket packet =
      packet_of(1, [](double x, double y) { return 8 * x * x + 15 * y * y + 0.1 * x; });
  packet.curve.slope_x = 20;
  const auto energy = [&](const Pose& X_JP) {
    FaceDepths face;
    face.set_face(packet.length, packet.width);
    face.look(packet, X_JP);
    return (packet.curve.stiffness * face.shares(packet.curve) *
            unit_curve(face.depth(), packet.curve.hardening).energy)
        .sum();
  };
  SkinContactParams params;
  params.friction = 0;
  Touch touch(params);
  touch.keep(packet);
  const Pose X_JP = pressed(3.1e-3, 0.7e-3, 0.03);
  touch.rest(X_JP);
  const Wrench wrench = touch.at(X_JP);
  constexpr double kStep = 1e-7;
  for (int k = 0; k < 3; ++k) {
    const Vec3 axis = Vec3::Unit(k);
    Pose ahead = X_JP;
    ahead.translation() += kStep * axis;
    Pose behind = X_JP;
    behind.translation() -= kStep * axis;
    EXPECT_NEAR(wrench.force[k], (energy(behind) - energy(ahead)) / (2 * kStep), 2e-3) << k;
    ahead = behind = X_JP;
    ahead.linear() = Eigen::AngleAxisd(kStep, axis) * X_JP.linear();
    behind.linear() = Eigen::AngleAxisd(-kStep, axis) * X_JP.linear();
    EXPECT_NEAR(wrench.torque[k], (energy(behind) - energy(ahead)) / (2 * kStep), 1e-5) << k;
  }
}

TEST(SkinContact, AHandOnClosedPathsLosesEnergyAtEveryRate) {
  for (const double rate : {1e3, 1e4}) {
    for (const double frequency : {0.3, 1.0, 4.0, 15.0}) {
      SkinContactParams params;
      params.tick_rate = rate;
      Touch touch(params);
      touch.keep(packet_of(1, [](double x, double y) { return 8 * x * x + 15 * y * y; }));
      double work = 0;  // by the hand
      Pose last = pressed(1e-3);
      Wrench felt = touch.at(last);
      const int n = static_cast<int>(4 / frequency * rate);
      for (int i = 1; i <= n; ++i) {
        const double phase = 2 * std::numbers::pi * frequency * i / rate;
        const Pose X_JP = pressed(1e-3 + 2e-3 * std::sin(phase), 2e-3 * std::sin(phase),
                                  0.02 * std::sin(2 * phase));
        const Eigen::AngleAxisd turn(X_JP.linear() * last.linear().transpose());
        work -= felt.force.dot(X_JP.translation() - last.translation()) +
                turn.angle() * felt.torque.dot(turn.axis());
        felt = touch.at(X_JP);
        last = X_JP;
      }
      EXPECT_GT(work, 1e-5) << rate << " Hz, hand " << frequency << " Hz";
    }
  }
}

TEST(SkinContact, LearnsAtItsPaceAndPaysForIt) {
  Touch touch;
  touch.keep(flat());
  double last = touch.rest(pressed(3e-3));
  touch.keep(flat(2, 1.5 * kStiffness));
  double largest = 0;
  for (int i = 0; i < 2000; ++i) {
    if (i % 33 == 0) touch.take(flat(3 + static_cast<std::uint64_t>(i), 1.5 * kStiffness));
    const double now = normal(touch.at(pressed(3e-3)));
    largest = std::max(largest, std::abs(now - last));
    last = now;
  }
  EXPECT_LT(largest, 20e-3 * kGain) << "N a tick";
  EXPECT_NEAR(last, 1.5 * force_at(3e-3), 0.01 * last);
}

/// A packet that says now much and now little gives the hand what bleeds in and no more.
TEST(SkinContact, PacketsThatChangeGiveNoMoreThanTheirAllowance) {
  Touch touch;
  touch.keep(flat());
  touch.rest(pressed(2e-3));
  double given = 0;
  Pose last = pressed(2e-3);
  Wrench felt = touch.at(last);
  constexpr int kTicks = 4000;
  for (int i = 1; i <= kTicks; ++i) {
    const double phase = 2 * std::numbers::pi * 2 * i / 1000.0;
    // Soft while it is pressed, stiff while it is let go: an engine, if it were believed.
    if (i % 33 == 0)
      touch.take(
          flat(1 + static_cast<std::uint64_t>(i), (std::cos(phase) > 0 ? 0.3 : 3) * kStiffness));
    const Pose X_JP = pressed(2e-3 + 1e-3 * std::sin(phase));
    given += felt.force.dot(X_JP.translation() - last.translation());
    felt = touch.at(X_JP);
    last = X_JP;
  }
  EXPECT_LT(given, 5e-3 * kTicks * 1e-3 + 2e-3);
}

TEST(SkinContact, HoldsSkinAndCurveWhileTheTissueIsLate) {
  Touch touch;
  touch.keep(flat());
  const double before = touch.rest(pressed(3e-3));
  ProbePacket old = flat(2, 3 * kStiffness);
  old.tick = touch.tick() - 150;
  touch.contact().take(old);
  for (int i = 0; i < 100; ++i) touch.at(pressed(3e-3));
  EXPECT_NEAR(normal(touch.at(pressed(3e-3))), before, 1e-6);
  EXPECT_TRUE(touch.contact().late());
  EXPECT_NEAR(touch.contact().age(), 0.251, 1e-9);
}

TEST(SkinContact, AnotherFrameOfTheSameSkinChangesNothing) {
  Touch touch;
  touch.keep(flat());
  const double before = touch.rest(pressed(3e-3, 2e-3));
  ProbePacket moved = flat(2);
  const Pose X_JF = pressed(1.5e-3, 4e-3);
  for (Eigen::Index i = 0; i < 12; ++i)
    moved.X_JF[static_cast<std::size_t>(i)] = X_JF.matrix()(i / 4, i % 4);
  moved.z.fill(-1.5e-3);
  touch.take(moved);
  for (int i = 0; i < 50; ++i)
    EXPECT_NEAR(normal(touch.at(pressed(3e-3, 2e-3))), before, 1e-9) << i;
}

TEST(SkinContact, SlidesByCoulombsLaw) {
  Touch touch;
  touch.keep(flat());
  const double press = touch.rest(pressed(3e-3));
  const auto along = [&](double x) {
    return touch.at(pressed(3e-3, x)).force.dot(skin_frame().linear().col(0));
  };
  EXPECT_NEAR(along(1e-5), -500 * 1e-5, 1e-9) << "it sticks";
  EXPECT_NEAR(along(2e-3), -0.05 * press, 1e-6) << "it slides";
  EXPECT_NEAR(along(0), 0.05 * press, 1e-6);
}

TEST(SkinContact, LeavesOutAPacketThatCannotBe) {
  Touch touch;
  touch.keep(flat());
  const double before = touch.rest(pressed(3e-3));
  ProbePacket bad = flat(2, 5 * kStiffness);
  bad.z[17] = std::numeric_limits<double>::quiet_NaN();
  touch.take(bad);
  for (int i = 0; i < 20; ++i) touch.at(pressed(3e-3));
  EXPECT_NEAR(normal(touch.at(pressed(3e-3))), before, 1e-6);
}

TEST(SkinContact, AllocatesAndLocksNothing) {
  SkinContact contact{SkinContactParams{}};
  const ProbePacket packet = flat();
  ARTUS_RUNS_REALTIME(SkinContact::take, contact.take(packet));
  ARTUS_RUNS_REALTIME(SkinContact::step, test::use(contact.step(pressed(1e-3), 1)));
  FaceDepths face;
  ARTUS_RUNS_REALTIME(FaceDepths::set_face, face.set_face(0.04, 0.006));
  ARTUS_RUNS_REALTIME(FaceDepths::look, face.look(packet, pressed(1e-3)));
  ARTUS_RUNS_REALTIME(FaceDepths::shares, test::use(face.shares(packet.curve)));
  ARTUS_RUNS_REALTIME(frame_of, test::use(frame_of(packet)));
  ARTUS_RUNS_REALTIME(unit_curve, test::use(unit_curve(face.depth(), 200)));
  ARTUS_RUNS_REALTIME(is_packet, test::use(is_packet(packet)));
  ARTUS_RUNS_REALTIME(force_at_rest, test::use(force_at_rest(packet, pressed(1e-3))));
}

TEST(FitCurve, FindsTheCurveThatMadeAPress) {
  ProbePacket packet = packet_of(1, [](double x, double y) { return 6 * x * x + 10 * y * y; });
  const TissueCurve truth{230, 140, 15, 0};
  const Pose X_JP = pressed(4e-3);
  FaceDepths face;
  face.set_face(packet.length, packet.width);
  face.look(packet, X_JP);
  const UnitCurve unit = unit_curve(face.depth(), truth.hardening);
  const FaceDepths::Row k = truth.stiffness * face.shares(truth);
  PressAtRest press;
  press.X_JP = X_JP;
  press.force.z() = -(k * unit.force).sum();
  press.torque = Vec3(-(k * unit.force * face.y()).sum(), (k * unit.force * face.x()).sum(), 0);
  press.stiffness = (face.depth() > 0).select(k * unit.stiffness, 0).sum();
  const TissueCurve found = fit_curve(packet, press, {});
  EXPECT_NEAR(found.hardening, truth.hardening, 4) << "slopes weigh the points of a bent skin";
  EXPECT_NEAR(found.slope_x, truth.slope_x, 1);
  FaceDepths again = face;
  EXPECT_NEAR(
      (found.stiffness * again.shares(found) * unit_curve(face.depth(), found.hardening).force)
          .sum(),
      -press.force.z(), 1e-9);
}

TEST(FitCurve, KeepsWhatALightPressDoesNotTell) {
  const TissueCurve before{100, 170, 3, -2};
  PressAtRest press;
  press.X_JP = pressed(0.3e-3);
  const TissueCurve same = fit_curve(flat(), press, before);
  EXPECT_EQ(same.stiffness, before.stiffness);
  press.force.z() = -0.1;
  const TissueCurve found = fit_curve(flat(), press, before);
  EXPECT_EQ(found.hardening, before.hardening);
  EXPECT_NE(found.stiffness, before.stiffness);
}

}  // namespace
}  // namespace artus
