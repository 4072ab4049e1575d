// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/evidence/validation/injection/injection_gates.h"

#include <gtest/gtest.h>

#include "artus/detail/evidence/validation/gates.h"

namespace artus {
namespace {

TEST(InjectionGates, HoldEachByItself) {
  for (const std::string_view name : gate_names("injection")) {
    const auto gate = run_gate("injection", name);
    ASSERT_TRUE(gate) << name;
    EXPECT_FALSE(gate->claims.empty()) << name;
    for (const Claim& claim : gate->claims) EXPECT_TRUE(claim.pass) << name << to_line(claim);
  }
}

}  // namespace
}  // namespace artus
