// SPDX-License-Identifier: AGPL-3.0-or-later
// The probe's tick under the allocation and lock counters.
#include <array>
#include <memory>

#include <gtest/gtest.h>

#include "artus/detail/haptics/probe/probe_contact.h"
#include "artus/detail/haptics/probe/probe_contact_column.h"
#include "artus/detail/haptics/probe/probe_contact_fields.h"
#include "tests/support/layered_body.h"
#include "tests/support/real_time.h"

namespace artus {
namespace {

using test::use;

TEST(RealTimeProbe, ColumnOfTissueNeitherAllocatesNorLocks) {
  const ColumnParams params;
  const std::array<ColumnLayer, 2> layers{{{2e-3, 1e5}, {20e-3, 15e3}}};
  ColumnResponse response;
  ARTUS_RUNS_REALTIME(compress_column, response = compress_column(params, layers, 10e-3));
  EXPECT_GT(response.pressure, 0);
  ARTUS_RUNS_REALTIME(complementary_energy,
                      use(complementary_energy(params, layers[0], response.pressure)));
}

TEST(RealTimeProbe, ContactNeitherAllocatesNorLocksOnAndOffTheSkin) {
  const std::array<test::FlatLayer, 2> layers{{{"skin", 2e-3}, {"muscle", 30e-3}}};
  ProbeContactModel model(std::make_shared<const Scene>(std::make_shared<const CompiledJoint>(
                              test::make_layered_block(layers, 0.12, 0.12))),
                          {});
  double strongest = 0;
  const auto press = [&] {
    for (int i = 0; i < 50; ++i) {
      const Vec3 p(1e-4 * i, 0, 1e-4 * i - 1e-3);
      const Vec3 axis = Vec3(0.01 * i, 0, 1).normalized();
      strongest = std::max(strongest, model.step(make_pose(p, axis, Vec3::UnitX())).normal_force);
    }
  };
  ARTUS_RUNS_REALTIME(ProbeContactModel::step, press(), use(model.step(Pose::Identity())));
  EXPECT_GT(strongest, 0);
  ARTUS_RUNS_REALTIME(ProbeContactModel::reset, model.reset());
}

TEST(ProbeContactFields, NameTheMembersOfTheFootprintAndTheColumn) {
  std::size_t n = 0;
  bool column = false;
  const ProbeContactParams params;
  visit_fields(params, [&](const std::string& name, const auto&) {
    ++n;
    column = column || name == "column.strain_limit";
  });
  EXPECT_EQ(n, 15U);
  EXPECT_TRUE(column);
}

}  // namespace
}  // namespace artus
