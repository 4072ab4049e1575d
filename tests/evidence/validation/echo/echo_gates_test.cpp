// SPDX-License-Identifier: AGPL-3.0-or-later
// The image's physics: what `artus validate echo` measures must hold.
#include "artus/detail/evidence/validation/echo/echo_gates.h"

#include <string>

#include <gtest/gtest.h>

#include "artus/detail/evidence/validation/gates.h"

namespace artus {
namespace {

class EchoGates : public testing::TestWithParam<std::string_view> {};

TEST_P(EchoGates, Hold) {
  const auto gate = run_gate("echo", GetParam());
  ASSERT_TRUE(gate.has_value()) << gate.error().to_string();
  ASSERT_FALSE(gate->claims.empty());
  for (const Claim& claim : gate->claims)
    EXPECT_TRUE(claim.pass) << claim.text << ": " << claim.value << ", must be " << claim.bound;
}

INSTANTIATE_TEST_SUITE_P(All, EchoGates, testing::ValuesIn(gate_names("echo", {})),
                         [](const auto& parameter) {
                           std::string name(parameter.param);
                           for (char& c : name)
                             if (c == '-') c = '_';
                           return name;
                         });

}  // namespace
}  // namespace artus
