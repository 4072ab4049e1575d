// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/evidence/validation/injection/injection_gates.h"

#include <gtest/gtest.h>

namespace artus {
namespace {

TEST(InjectionGates, HoldEachByItself) {
  for (const auto& [name, measure] : injection_gates().gates) {
    const auto gate = run_gate(injection_gates(), name);
    ASSERT_TRUE(gate) << name;
    EXPECT_FALSE(gate->claims.empty()) << name;
    for (const Claim& claim : gate->claims) EXPECT_TRUE(claim.pass) << name << to_line(claim);
  }
}

TEST(InjectionGates, AnUnknownNameIsRefusedWithTheNamesThereAre) {
  const auto gate = run_gate(injection_gates(), "no-such");
  ASSERT_FALSE(gate);
  EXPECT_EQ(gate.error().code, ErrorCode::not_found);
  EXPECT_NE(gate.error().message.find("aspiration"), std::string::npos);
}

}  // namespace
}  // namespace artus
