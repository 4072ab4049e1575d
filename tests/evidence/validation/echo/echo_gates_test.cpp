// SPDX-License-Identifier: AGPL-3.0-or-later
// The gate table of the image's physics: what `artus echo-gates` measures must hold.
#include "artus/detail/evidence/validation/echo/echo_gates.h"

#include <string>

#include <gtest/gtest.h>

namespace artus {
namespace {

class EchoGates : public testing::TestWithParam<std::string_view> {};

TEST_P(EchoGates, Hold) {
  const auto gate = run_echo_gate(GetParam());
  ASSERT_TRUE(gate.has_value()) << gate.error().to_string();
  ASSERT_FALSE(gate->claims.empty());
  for (const Claim& claim : gate->claims)
    EXPECT_TRUE(claim.pass) << claim.text << ": " << claim.value << ", must be " << claim.bound;
}

INSTANTIATE_TEST_SUITE_P(All, EchoGates,
                         testing::ValuesIn(echo_gates().begin(), echo_gates().end()),
                         [](const auto& parameter) {
                           std::string name(parameter.param);
                           for (char& c : name)
                             if (c == '-') c = '_';
                           return name;
                         });

TEST(EchoGatesList, AnUnknownGateIsRefusedWithTheKnownOnes) {
  const auto gate = run_echo_gate("speckles");
  ASSERT_FALSE(gate.has_value());
  EXPECT_EQ(gate.error().code, ErrorCode::not_found);
  EXPECT_NE(gate.error().message.find("needle-rings"), std::string::npos);
}

}  // namespace
}  // namespace artus
