// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/haptics/probe/probe_tangent.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "tests/support/real_time.h"

namespace artus {
namespace {

constexpr double kTicks = 1000;  // Hz
constexpr double kPackets = 40;  // Hz
constexpr double kFriction = 0.05;

/// A face pressed with `normal` N on a spring of `stiffness` N/m along z and 2 N m/rad about y.
ProbePacket packet_of(std::uint64_t number, const Pose& X_JP, double normal, double stiffness) {
  ProbePacket packet;
  packet.number = number;
  for (Eigen::Index i = 0; i < 12; ++i)
    packet.X_JP[static_cast<std::size_t>(i)] = X_JP.matrix()(i / 4, i % 4);
  packet.wrench[2] = -normal;
  packet.stiffness[6 * 2 + 2] = stiffness;
  packet.stiffness[6 * 4 + 4] = 2;
  packet.share = 0.5;
  return packet;
}

Pose raised(double height) {
  Pose pose =
      make_pose(Vec3(0.1, 0.2, 0.3), Vec3(1, 2, 2).normalized(), Vec3(2, 1, -2).normalized());
  pose.translation() -= height * pose.linear().col(2);
  return pose;
}

/// The force along the face's axis out of the body once the blend is over.
double settled(ProbeTangent& tangent, const Pose& X_JP) {
  for (int i = 0; i < 40; ++i) static_cast<void>(tangent.step(X_JP));
  return -tangent.step(X_JP).force.dot(X_JP.linear().col(2));
}

TEST(ProbeTangent, FollowsTheSpringOfItsPacket) {
  ProbeTangent tangent(kTicks, kPackets, kFriction);
  tangent.take(packet_of(1, raised(0), 3, 500));
  EXPECT_NEAR(settled(tangent, raised(0)), 3, 1e-12);
  EXPECT_NEAR(settled(tangent, raised(-1e-3)), 3.5, 1e-12);
  EXPECT_NEAR(settled(tangent, raised(2e-3)), 2, 1e-12);
  EXPECT_NEAR(settled(tangent, raised(-10e-3)), 3 + 500 * 3e-3, 1e-12) << "held beyond 3 mm";
  const Pose turned = raised(0) * Eigen::AngleAxisd(0.01, Vec3::UnitY());
  static_cast<void>(settled(tangent, turned));
  EXPECT_NEAR(tangent.step(turned).torque.dot(raised(0).linear().col(1)), -0.02, 1e-9);
}

TEST(ProbeTangent, NeverPulls) {
  ProbeTangent tangent(kTicks, kPackets, kFriction);
  tangent.take(packet_of(1, raised(0), 0.5, 500));
  EXPECT_EQ(settled(tangent, raised(1.001e-3)), 0);
  EXPECT_EQ(tangent.step(std::nullopt).force, Vec3::Zero());
  EXPECT_GT(settled(tangent, raised(0.999e-3)), 0);
}

TEST(ProbeTangent, SlidesByCoulombsLawBetweenPackets) {
  ProbeTangent tangent(kTicks, kPackets, kFriction);
  ProbePacket packet = packet_of(1, raised(0), 3, 500);
  packet.wrench[0] = -0.1;
  packet.stiffness[0] = 400;
  tangent.take(packet);
  static_cast<void>(settled(tangent, raised(0)));
  const auto along = [&](double distance) {
    Pose X_JP = raised(0);
    X_JP.translation() += distance * X_JP.linear().col(0);
    return tangent.step(X_JP).force.dot(X_JP.linear().col(0));
  };
  EXPECT_NEAR(along(0), -0.1, 1e-12);
  EXPECT_NEAR(along(1e-4), -0.14, 1e-12) << "it sticks";
  EXPECT_NEAR(along(1e-3), -0.15, 1e-12) << "0.05 of 3 N";
  EXPECT_NEAR(along(-2e-3), 0.15, 1e-12);
}

TEST(ProbeTangent, SaysThatItTouchesAsLongAsItPresses) {
  ProbeTangent tangent(kTicks, kPackets, kFriction);
  tangent.take(packet_of(1, raised(0), 3, 500));
  EXPECT_NEAR(settled(tangent, raised(0)), 3, 1e-12);
  EXPECT_NEAR(tangent.share(), 0.5, 1e-12);
  ProbePacket off = packet_of(2, raised(0), 0, 0);
  off.share = 0;
  tangent.take(off);
  for (int i = 0; i < 30; ++i) {
    const bool presses = tangent.step(raised(0)).force.norm() > 0;
    EXPECT_EQ(presses, tangent.share() > 0) << i;
  }
  EXPECT_EQ(tangent.share(), 0);
}

TEST(ProbeTangent, GoesFromPacketToPacketWithoutAStep) {
  ProbeTangent tangent(kTicks, kPackets, kFriction);
  tangent.take(packet_of(1, raised(0), 3, 500));
  double last = settled(tangent, raised(0));
  tangent.take(packet_of(2, raised(0), 4, 700));
  double most = 0;
  for (int i = 0; i < 25; ++i) {
    const double now = -tangent.step(raised(0)).force.dot(raised(0).linear().col(2));
    most = std::max(most, std::abs(now - last));
    last = now;
  }
  EXPECT_NEAR(last, 4, 1e-9);
  EXPECT_NEAR(most, 1 / 25.0, 1e-9) << "one N over the 25 ticks of a packet's period";
}

TEST(ProbeTangent, LeavesOutAPacketThatIsNotFinite) {
  ProbeTangent tangent(kTicks, kPackets, kFriction);
  tangent.take(packet_of(1, raised(0), 3, 500));
  ProbePacket bad = packet_of(2, raised(0), 3, 500);
  bad.stiffness[7] = std::numeric_limits<double>::quiet_NaN();
  tangent.take(bad);
  EXPECT_NEAR(settled(tangent, raised(0)), 3, 1e-12);
}

/// Packets lost for 0.2 s under a hand that moves with 2 Hz on a spring that hardens: what is felt
/// against the spring itself.
TEST(ProbeTangent, IsNearTheTissueAtEveryRateOfPackets) {
  const auto force = [](double depth) {
    return 300 * depth + 2e5 * depth * depth;
  };
  for (const double rate : {30.0, 60.0, 120.0}) {
    ProbeTangent tangent(kTicks, rate, kFriction);
    double error = 0;
    double power = 0;
    double largest_step = 0;
    double last = 0;
    int number = 0;
    double next = 0;
    for (int i = 0; i < 3000; ++i) {
      const double t = i / kTicks;
      const double depth = 4e-3 + 1e-3 * std::sin(2 * 3.14159265 * 2 * t);
      const bool lost = t > 1.5 && t < 1.7;
      if (t >= next && !lost) {
        tangent.take(packet_of(static_cast<std::uint64_t>(++number), raised(-depth), force(depth),
                               300 + 4e5 * depth));
        next = t + 1 / rate;
      }
      const double felt = -tangent.step(raised(-depth)).force.dot(raised(0).linear().col(2));
      if (t > 0.2) {
        error += (felt - force(depth)) * (felt - force(depth));
        power += force(depth) * force(depth);
        largest_step = std::max(largest_step, std::abs(felt - last));
      }
      last = felt;
    }
    EXPECT_LT(std::sqrt(error / power), 0.02) << rate;
    EXPECT_LT(largest_step, 0.07 * force(5e-3)) << "half the JND of 14 %, " << rate;
  }
}

TEST(ProbeTangent, AllocatesAndLocksNothing) {
  ProbeTangent tangent(kTicks, kPackets, kFriction);
  const ProbePacket packet = packet_of(1, raised(0), 3, 500);
  ARTUS_RUNS_REALTIME(ProbeTangent::take, tangent.take(packet));
  ARTUS_RUNS_REALTIME(ProbeTangent::step, test::use(tangent.step(raised(1e-4))));
}

}  // namespace
}  // namespace artus
