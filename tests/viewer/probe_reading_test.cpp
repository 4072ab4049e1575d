// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/viewer/panels/probe_reading.h"

#include <algorithm>
#include <iterator>

#include <gtest/gtest.h>

namespace artus {
namespace {

/// A probe that looks along x, with what its hand feels in frame W.
HapticSnapshot felt(const Vec3& force, double share) {
  HapticSnapshot now;
  now.input.device.has_probe = 1;
  now.input.device.X_WP = to_plain(make_pose(Vec3(0.1, 0, 0), Vec3::UnitX(), Vec3::UnitY()));
  std::copy(force.begin(), force.end(), std::begin(now.feedback.probe_force));
  now.feedback.probe_share = share;
  return now;
}

SessionParams giving_way() {
  SessionParams params;
  params.deform = true;
  return params;
}

TEST(ProbeReading, TellsThePressAlongTheProbeAndHowMuchOfItsFaceTouches) {
  const ProbeReading probe = read_probe(felt(Vec3(-3.24, 1, 0.5), 0.54), giving_way());
  EXPECT_TRUE(probe.felt);
  EXPECT_NEAR(probe.force, 3.24, 1e-12);
  EXPECT_EQ(describe_probe(Language::english, probe),
            "probe 3.2 N, 54 % of its face in contact, tissue 0 ms old");
  EXPECT_EQ(describe_probe(Language::french, probe),
            "sonde 3,2 N, 54 % de sa face en contact, tissus vieux de 0 ms");
}

TEST(ProbeReading, SaysWhyItsForceIsHeldBack) {
  HapticSnapshot now = felt(Vec3(-1, 0, 0), 0.5);
  now.feedback.probe_status = TickStatus::kRamping;
  EXPECT_EQ(describe_probe(Language::english, read_probe(now, giving_way())),
            "probe 1.0 N, 50 % of its face in contact, tissue 0 ms old: force ramps up");
}

TEST(ProbeReading, IsSilentWithoutAProbeAndWhereTheBodyIsRigid) {
  EXPECT_EQ(describe_probe(Language::english, read_probe(felt(Vec3(-1, 0, 0), 1), {})), "");
  HapticSnapshot now = felt(Vec3(-1, 0, 0), 1);
  now.input.device.has_probe = 0;
  EXPECT_EQ(describe_probe(Language::english, read_probe(now, giving_way())), "");
  EXPECT_EQ(press_of_probe(now), 0);
}

}  // namespace
}  // namespace artus
