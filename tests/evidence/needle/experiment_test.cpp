// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/evidence/needle/experiment.h"

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
  for (const auto& row : run->table.rows)
    EXPECT_EQ(row.size(), run->table.header.size()) << "a cell under another's header";
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

TEST(NeedleExperiments, LawThatTheExperimentFixesIsRefusedByName) {
  ExperimentOptions options;
  options.feel.cutting.all = CuttingLaw::voigt;
  const auto refused = run_needle_experiment("wall-vs-classic", options);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::invalid);
  EXPECT_EQ(refused.error().where, "cutting");
  EXPECT_NE(refused.error().message.find("compares four fixed"), std::string::npos);
  ExperimentOptions layer;
  layer.feel.cutting.of_tissue["layer 2"] = CuttingLaw::voigt;
  const auto unknown = run_needle_experiment("wall-move", layer);
  ASSERT_FALSE(unknown);
  EXPECT_EQ(unknown.error().code, ErrorCode::not_found);
  EXPECT_NE(unknown.error().message.find("layer 1"), std::string::npos);
}

// The direct law of one layer of nine: its force is there at once, the others build up as before.
TEST(NeedleExperiments, LawOfOneLayerChangesThatLayerAlone) {
  ExperimentOptions options;
  options.feel.cutting.of_tissue["layer 6"] = CuttingLaw::direct;
  const auto wall = run_needle_experiment("wall-nine");
  const auto mixed = run_needle_experiment("wall-nine", options);
  ASSERT_TRUE(wall);
  ASSERT_TRUE(mixed);
  const auto first_in_layer = [](const Experiment& e, RegionId region) {
    for (const NeedleRow& row : e.traces[0].rows)
      if (row.region == region) return -row.forces.cutting;
    return 0.0;
  };
  const RegionId sixth = kFirstRegion + 5;
  EXPECT_LT(first_in_layer(*wall, sixth), 3.1);
  EXPECT_NEAR(first_in_layer(*mixed, sixth), 3.5, 1e-9);
  EXPECT_EQ(first_in_layer(*mixed, sixth - 1), first_in_layer(*wall, sixth - 1));
}

// The spring pushes a needle that stopped: the published claims say so.
TEST(NeedleExperiments, ClaimsOfTheWallFailWithASpring) {
  ExperimentOptions options;
  options.feel.cutting.all = CuttingLaw::spring;
  const auto run = run_needle_experiment("wall-stop", options);
  ASSERT_TRUE(run);
  bool rest_holds = true;
  for (const Claim& c : run->claims)
    if (c.text.find("stays 0") != std::string::npos) rest_holds = c.pass;
  EXPECT_FALSE(rest_holds);
}

}  // namespace
}  // namespace artus
