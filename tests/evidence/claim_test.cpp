// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/evidence/claim.h"

#include <limits>
#include <vector>

#include <gmock/gmock.h>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace artus {
namespace {

using testing::HasSubstr;

// Two independent ones that hold and one that fails, one fitted, two inputs of which one fails.
std::vector<Claim> six_claims() {
  return {claim_at_most(ClaimKind::independent, "a", 1, 2, "N"),
          claim_at_least(ClaimKind::independent, "b", 1, 2, "N"),
          claim_near({ClaimKind::fitted, "3 ms"}, "c", 1.9, 2, 0.1, "N"),
          claim_within({ClaimKind::input, "table 4.2"}, "d", 1.9, 2, 0.01, "N"),
          claim_that({ClaimKind::input, "the plan"}, "e", true),
          claim_within(ClaimKind::independent, "f", 1.9, 2, 0.2, "N")};
}

TEST(Claim, HoldsUpToItsBoundAndNoFarther) {
  const auto claims = six_claims();
  EXPECT_TRUE(claims[0].pass);
  EXPECT_FALSE(claims[1].pass);
  EXPECT_TRUE(claims[2].pass);
  EXPECT_FALSE(claims[3].pass);
  EXPECT_TRUE(claims[4].pass);
  EXPECT_TRUE(claim_at_most(ClaimKind::input, "", 2, 2, "").pass);
  EXPECT_FALSE(claim_near(ClaimKind::input, "", -2, 2, 0.5, "").pass);
}

TEST(Claim, NothingHoldsOfWhatIsNotANumber) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(claim_at_most(ClaimKind::input, "", kNan, 1, "").pass);
  EXPECT_FALSE(claim_at_least(ClaimKind::input, "", kNan, 1, "").pass);
  EXPECT_FALSE(claim_near(ClaimKind::input, "", kNan, 1, 1, "").pass);
  EXPECT_FALSE(claim_within(ClaimKind::input, "", kNan, 1, 1, "").pass);
}

TEST(Claim, KindsAreCountedApart) {
  EXPECT_EQ(count_claims(six_claims()),
            "2 independent hold, 1 fail; 1 fitted; 2 inputs checked (1 fails)");
  EXPECT_EQ(count_claims({}), "0 independent hold, 0 fail; 0 fitted; 0 inputs checked");
}

TEST(Claim, VerdictHasTheCountsAndWhatEachRestsOn) {
  const nlohmann::json json = verdict(six_claims());
  EXPECT_FALSE(json.at("pass").get<bool>());
  EXPECT_EQ(json.at("counts").at("independent").at("hold"), 2);
  EXPECT_EQ(json.at("counts").at("independent").at("fail"), 1);
  EXPECT_EQ(json.at("counts").at("fitted").at("hold"), 1);
  EXPECT_EQ(json.at("counts").at("input").at("fail"), 1);
  EXPECT_EQ(json.at("claims").at(2).at("kind"), "fitted");
  EXPECT_EQ(json.at("claims").at(2).at("why"), "3 ms");
}

TEST(Claim, LineAndTableSayTheKindAndWhetherItHolds) {
  const auto claims = six_claims();
  EXPECT_EQ(to_line(claims[1]), "FAILS  independent  b: 1 (>= 2 N)");
  const std::string table = to_markdown(claims);
  EXPECT_THAT(table, HasSubstr("| b | 1 | >= 2 N | independent | **no** |"));
  EXPECT_THAT(table, HasSubstr("| c | 1.9 | 2 N +- 10 % | fitted: 3 ms | yes |"));
  EXPECT_THAT(table, HasSubstr(count_claims(claims)));
}

TEST(Claim, OfWhichNoneIsIndependentAreSaidToBeNoEvidence) {
  auto claims = six_claims();
  EXPECT_EQ(tell_lack_of_evidence(claims), "");
  EXPECT_FALSE(verdict(claims).contains("evidence"));
  claims = {claims[2], claims[4]};
  EXPECT_THAT(tell_lack_of_evidence(claims), HasSubstr("no evidence"));
  EXPECT_TRUE(verdict(claims).contains("evidence"));
}

TEST(Claim, AllHoldOnlyWhenEachDoes) {
  auto claims = six_claims();
  EXPECT_FALSE(all_hold(claims));
  claims = {claims[0], claims[2]};
  EXPECT_TRUE(all_hold(claims));
}

}  // namespace
}  // namespace artus
