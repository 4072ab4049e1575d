// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/evidence/soft/soft_gates.h"

#include <gtest/gtest.h>

namespace artus {
namespace {

class SoftGates : public testing::TestWithParam<const char*> {};

TEST_P(SoftGates, Hold) {
  const auto gate = run_gate(soft_gates(), GetParam());
  ASSERT_TRUE(gate);
  EXPECT_FALSE(gate->claims.empty());
  for (const Claim& claim : gate->claims) EXPECT_TRUE(claim.pass) << to_line(claim);
}

// Without "point-force", whose nearest point on the surface is out of its bound
// (docs/deformation.md), and those that tests/soft measures in another form.
INSTANTIATE_TEST_SUITE_P(All, SoftGates,
                         testing::Values("patch", "uniaxial", "cantilever", "punch", "layers",
                                         "volume", "turned"));

TEST(SoftGateList, UnknownNameIsRefusedWithTheNamesThereAre) {
  const auto gate = run_gate(soft_gates(), "no-such");
  ASSERT_FALSE(gate);
  EXPECT_EQ(gate.error().code, ErrorCode::not_found);
  EXPECT_NE(gate.error().message.find("punch"), std::string::npos);
}

TEST(SoftGateList, ReportNamesTheGateOfEachClaim) {
  const auto gate = run_gate(soft_gates(), "patch");
  ASSERT_TRUE(gate);
  const EvidenceReport report = report_of(soft_gates(), std::vector{*gate});
  ASSERT_EQ(report.claims.size(), gate->claims.size());
  EXPECT_EQ(report.name, "soft-gates");
  EXPECT_EQ(report.claims[0].text.rfind("patch: ", 0), 0U);
}

}  // namespace
}  // namespace artus
