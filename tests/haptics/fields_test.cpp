// SPDX-License-Identifier: AGPL-3.0-or-later
#include <set>

#include <gtest/gtest.h>

#include "artus/detail/haptics/guard_fields.h"
#include "artus/detail/haptics/wrench.h"

namespace artus {
namespace {

template <class P>
std::set<std::string> names_of(const P& params) {
  std::set<std::string> names;
  visit_fields(params, [&names](const std::string& name, const auto&) { names.insert(name); });
  return names;
}

TEST(GuardFields, AreNamedAsTheirMembers) {
  EXPECT_EQ(
      names_of(GuardParams{}),
      (std::set<std::string>{"force_slew", "max_speed", "max_turn_rate", "ramp_time", "stale_after",
                             "torque_slew", "workspace_centre", "workspace_half"}));
  EXPECT_EQ(names_of(PassivityParams{}), (std::set<std::string>{"control", "max_damping"}));
  EXPECT_EQ(names_of(DeviceLimits{}),
            (std::set<std::string>{"damping", "encoder_step", "force", "mass", "needle_centre",
                                   "needle_half", "probe_centre", "probe_force", "probe_half",
                                   "probe_torque", "torque", "workspace"}));
}

TEST(Wrench, AddsForcesAndTorquesApart) {
  Wrench sum{Vec3(1, 0, 0), Vec3(0, 1, 0)};
  sum += {Vec3(0, 2, 0), Vec3(0, 0, 3)};
  EXPECT_EQ(sum.force, Vec3(1, 2, 0));
  EXPECT_EQ(sum.torque, Vec3(0, 1, 3));
}

}  // namespace
}  // namespace artus
