// SPDX-License-Identifier: AGPL-3.0-or-later
#include "sim/experiment.h"

#include <string>
#include <string_view>

#include <gtest/gtest.h>

namespace artus {
namespace {

class NeedleExperiment : public ::testing::TestWithParam<std::string_view> {};

TEST_P(NeedleExperiment, ShowsWhatThePublishedOneShows) {
  const auto run = run_needle_experiment(GetParam());
  ASSERT_TRUE(run) << run.error().to_string();
  EXPECT_FALSE(run->claims.empty());
  for (const Claim& c : run->claims)
    EXPECT_TRUE(c.pass) << c.text << ": " << c.value << ' ' << c.bound;
}

INSTANTIATE_TEST_SUITE_P(All, NeedleExperiment,
                         ::testing::ValuesIn(needle_experiments().begin(),
                                             needle_experiments().end()),
                         [](const auto& param) {
                           std::string name(param.param);
                           for (char& c : name) {
                             if (c == '-') c = '_';
                           }
                           return name;
                         });

TEST(NeedleExperiments, UnknownNameIsRefusedWithTheNamesThereAre) {
  const auto refused = run_needle_experiment("wall-of-china");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::not_found);
  EXPECT_NE(refused.error().message.find("wall-seven"), std::string::npos);
}

}  // namespace
}  // namespace artus
