// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/evidence/validation/probe/probe_experiment.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "artus/detail/evidence/validation/gates.h"
#include "artus/detail/evidence/validation/probe/probe_experiment_observed.h"
#include "artus/detail/evidence/validation/probe/probe_experiments.h"

namespace artus {
namespace {

TEST(ProbeExperimentProfiles, RampRisesEvenlyAndStays) {
  const auto target = ramp_stiffness(500, 1000, 10, 25);
  EXPECT_DOUBLE_EQ(target(0).stiffness, 500);
  EXPECT_DOUBLE_EQ(target(17.5).stiffness, 750);
  EXPECT_DOUBLE_EQ(target(40).stiffness, 1000);
}

TEST(ProbeExperimentProfiles, StepsTakeTheValuesInTurn) {
  const auto target = step_stiffness({500, 1000, 800}, 10, 5);
  EXPECT_DOUBLE_EQ(target(0).stiffness, 500);
  EXPECT_DOUBLE_EQ(target(14.9).stiffness, 500);
  EXPECT_DOUBLE_EQ(target(15.1).stiffness, 1000);
  EXPECT_DOUBLE_EQ(target(99).stiffness, 800);
}

TEST(ProbeExperimentProfiles, LaidMassWeighsInFullAfterTheHandLetsGo) {
  const auto load = lay_mass(1, 10);
  EXPECT_EQ(load(9.9, {}).mass, 0);
  EXPECT_NEAR(load(10, {}).force, -kGravity, 1e-12);
  EXPECT_EQ(load(10.4, {}).force, 0);
  EXPECT_EQ(load(10.4, {}).mass, 1);
}

TEST(ProbeExperimentWindow, MeasuresOnlyItsRows) {
  std::vector<ProbeRow> rows(4);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    rows[i].time = static_cast<double>(i);
    rows[i].u_P = i % 2 == 0 ? 5 : 6;
    rows[i].expected = 1e-3 * static_cast<double>(i);
    rows[i].pneumatic = 2000 + static_cast<double>(i);
  }
  const ProbeWindow w = measure_window(rows, 1, 4);
  EXPECT_DOUBLE_EQ(w.largest_error, 3e-3);
  EXPECT_DOUBLE_EQ(w.mean_error, 2e-3);
  EXPECT_DOUBLE_EQ(w.voltage_travel, 2.0 / 3);
  EXPECT_DOUBLE_EQ(w.lowest_pneumatic, 2001);
}

const ProbeExperiment& isp() {
  static const ProbeExperiment experiment = run_probe_isp({});
  return experiment;
}

const ProbeExperiment& ssp() {
  ProbeExperimentOptions options;
  options.assumptions = false;
  static const ProbeExperiment experiment = run_probe_ssp(options);
  return experiment;
}

// An observation that docs/probe.md calls refuted, and what artus measures.
struct Refuted {
  std::string what;
  double artus;
  double tolerance;
};

// All claims hold but these, which are independent and have these values.
void expect_refuted(const ProbeExperiment& e, const std::vector<Refuted>& refuted) {
  std::size_t failing = 0;
  for (const Claim& c : e.claims) {
    const auto known = std::find_if(refuted.begin(), refuted.end(),
                                    [&c](const Refuted& r) { return r.what == c.text; });
    EXPECT_EQ(c.pass, known == refuted.end()) << c.text << ": " << c.value;
    if (known == refuted.end()) continue;
    ++failing;
    EXPECT_NEAR(c.value, known->artus, known->tolerance) << c.text;
  }
  EXPECT_EQ(failing, refuted.size());
}

TEST(ProbeExperiment, IncreasingStiffnessRefutesWhatTheDocumentSays) {
  expect_refuted(isp(), {{"ipc: error in steady state", 1.37, 0.02},
                         {"backstepping: error in steady state", 1.73, 0.02},
                         {"backstepping: highest K_pneu", 2390, 10}});
  EXPECT_EQ(isp().plots.size(), 4U);
}

TEST(ProbeExperiment, StiffnessStepsRefuteWhatTheDocumentSays) {
  expect_refuted(
      ssp(), {{"backstepping's steady-state error over that of PID and IPC", 597.8, 2},
              {"ipc: turns of the voltage by more than 0.2 V after a step", 0.33, 0.01},
              {"backstepping: turns of the voltage by more than 0.2 V after a step", 5.67, 0.01},
              {"pid: control voltage after the first peak, off steps", 6.75, 0.02}});
}

TEST(ProbeExperiment, EveryObservationIsAClaimAndHasACauseWhenItIsRefuted) {
  for (const ProbeExperiment* experiment : {&isp(), &ssp()}) {
    EXPECT_GE(experiment->observations.size(), 8U);
    for (std::size_t i = 0; i < experiment->observations.size(); ++i) {
      const ProbeObservation& o = experiment->observations[i];
      EXPECT_TRUE(std::isfinite(o.artus)) << o.what;
      EXPECT_FALSE(o.difference.empty()) << o.what;
      EXPECT_NE(o.reproduced, !o.cause.empty()) << o.what;
      EXPECT_EQ(experiment->claims[i].text, o.what);
      EXPECT_EQ(experiment->claims[i].pass, o.reproduced);
    }
  }
}

TEST(ProbeExperiment, CauseIsNamedOnlyWhenARerunWithoutItReproduces) {
  std::vector<ProbeObservation> base(3);
  base[0].reproduced = true;
  ProbeRerun helps{"no friction", base};
  helps.observations[1].reproduced = true;
  helps.observations[1].artus = 0.25;
  helps.observations[1].unit = "mm";
  const ProbeRerun other{"a slower spool", base};
  auto looked = base;
  find_causes({other, helps}, looked);
  EXPECT_EQ(looked[0].cause, "");
  EXPECT_EQ(looked[1].cause, "reproduced with no friction: 0.25 mm");
  EXPECT_EQ(looked[2].cause, "none of the other values reproduces it");
  find_causes({}, base);
  EXPECT_EQ(base[1].cause, "not looked for");
}

TEST(ProbeExperiment, SupplyReadAsGaugeMovesThePneumaticStiffness) {
  // Which verdicts hang on the value that was fitted is part of the report.
  ASSERT_EQ(isp().tables.size(), 3U);
  const TextTable& varied = isp().tables[2].second;
  EXPECT_GE(varied.rows.size(), 7U);
  EXPECT_EQ(varied.rows[0][2], "none");
  EXPECT_THAT(varied.rows[1][0], testing::HasSubstr("gauge"));
  EXPECT_THAT(varied.rows[1][2], testing::HasSubstr("K_pneu"));
}

TEST(ProbeExperiment, MockFromAFileIsTheOneThatRuns) {
  ProbeExperimentOptions options;
  options.assumptions = false;
  options.mock =
      parse_pneumatic_params("format = 1\n[cylinder]\ndry_friction_n = 0\n", "t").value();
  const ProbeExperiment experiment = run_probe_isp(options);
  EXPECT_LT(measure_window(experiment.traces[2].rows, 33, 35).mean_error, 0.05e-3);
}

TEST(ProbeExperiment, DryFrictionIsWhatHoldsBackstepping) {
  EXPECT_NEAR(measure_window(isp().traces.at(2).rows, 33, 35).mean_error, 5.2 / 3000, 0.1e-3);
  for (const ProbeObservation& o : isp().observations) {
    if (o.what == "backstepping: error in steady state") {
      EXPECT_THAT(o.cause, testing::HasSubstr("no dry friction"));
    }
  }
}

TEST(ProbeExperiment, SameSeedGivesTheSameTraceAndAnotherSeedAnother) {
  ProbeScenario scenario;
  scenario.duration = 0.2;
  scenario.target = ramp_stiffness(800, 900, 0, 1);
  const std::string a = probe_csv(run_probe_scenario(scenario));
  EXPECT_EQ(a, probe_csv(run_probe_scenario(scenario)));
  scenario.seed = 2;
  EXPECT_NE(a, probe_csv(run_probe_scenario(scenario)));
}

TEST(ProbeExperiment, StudyHoldsWhatMustHoldAndHasARowPerLawAndCylinder) {
  const auto study = run_gate("probe", "probe-study");
  ASSERT_TRUE(study);
  ASSERT_EQ(study->tables.size(), 3U);
  EXPECT_EQ(study->tables[0].second.rows.size(), 8U);
  EXPECT_EQ(study->tables[1].second.rows.size(), 8U);
  for (const Claim& c : study->claims) EXPECT_TRUE(c.pass) << c.text << ": " << c.value;
}

TEST(ProbeExperiment, WrittenVerdictCanBeReadBack) {
  const auto folder = std::filesystem::temp_directory_path() / "artus-probe-experiment-test";
  std::filesystem::remove_all(folder);
  const auto measured = measure_probe_experiment(
      "probe-isp", [](const ProbeExperimentOptions&) { return isp(); }, {});
  ASSERT_TRUE(measured);
  Gate small = *measured;
  small.plots.clear();
  const auto written = write_report(small, folder);
  ASSERT_TRUE(written) << written.error().to_string();
  std::ifstream in(folder / "verdict.json");
  const nlohmann::json json = nlohmann::json::parse(in);
  EXPECT_FALSE(json.at("pass").get<bool>());
  EXPECT_EQ(json.at("claims").size(), small.claims.size());
  EXPECT_EQ(json.at("counts").at("independent").at("fail"), 3);
  EXPECT_TRUE(std::filesystem::exists(folder / "probe-isp-backstepping.csv"));
  EXPECT_TRUE(std::filesystem::exists(folder / "report.md"));
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace artus
