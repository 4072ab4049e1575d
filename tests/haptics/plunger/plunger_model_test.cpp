// SPDX-License-Identifier: AGPL-3.0-or-later
// The plunger at 1 kHz against 260 rows of an independent model in Python, whose needles, liquids,
// barrels, places and thumbs are drawn by chance within what the plunger is meant for. How the rows
// are made: make_oracle_rows.py beside this file.
#include <array>
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

#include "artus/detail/haptics/plunger/plunger.h"
#include "tests/haptics/plunger/plunger_fixture.h"
#include "tests/support/paths.h"

namespace artus {
namespace {

using OracleCase = std::map<std::string, double>;

std::vector<OracleCase> read_rows() {
  std::ifstream in(test::source_dir() / "tests/haptics/plunger/oracle_rows.csv");
  std::vector<std::string> names;
  std::vector<OracleCase> rows;
  std::string line;
  while (std::getline(in, line)) {
    std::istringstream cells(line);
    std::string cell;
    std::size_t k = 0;
    if (!names.empty()) rows.emplace_back();
    while (std::getline(cells, cell, ','))
      if (rows.empty())
        names.push_back(cell);
      else
        rows.back()[names.at(k++)] = std::stod(cell);
  }
  return rows;
}

PlungerParams params_of(const OracleCase& row) {
  PlungerParams params = test::water_syringe(row.at("entry_loss"));
  params.syringe.diameter = row.at("diameter");
  params.syringe.break_loose = row.at("break_loose");
  params.syringe.glide = row.at("glide");
  // The model's air is as soft as it is at rest.
  params.syringe.compliance = row.at("compliance") + row.at("air") / Syringe::kAtmosphere;
  params.needle.diameter = row.at("bore");
  params.needle.length = row.at("length");
  params.liquid.viscosity = {row.at("viscosity"), row.at("viscosity"), 0, 1};
  if (row.at("power") < 1)
    params.liquid.viscosity = {row.at("viscosity"), row.at("infinite"), row.at("relaxation"),
                               row.at("power")};
  params.grip = 1e9;
  return params;
}

std::vector<Space> places_of(const OracleCase& row) {
  SpaceLaw law;
  law.kind = static_cast<SpaceKind>(static_cast<int>(row.at("kind")));
  law.opening = row.at("opening");
  law.resistance = row.at("resistance");
  law.rest = row.at("rest");
  law.stiffness = row.at("stiffness");
  law.slack = row.at("slack");
  law.toe = row.at("toe");
  law.peak = row.at("peak");
  law.peak_volume = row.at("peak_volume");
  std::vector<Space> places = test::one_space(law);
  if (row.at("leak_resistance") > 0) {
    places[0].leaks_to = "sink";
    places[0].leak_opening = row.at("leak_opening");
    places[0].leak_resistance = row.at("leak_resistance");
    places.push_back(test::one_space(test::level(0), "sink")[0]);
  }
  return places;
}

PlungerInput thumb_at(const OracleCase& row, double t) {
  PlungerInput input = test::thumb(row.at("force") + row.at("slope") * t +
                                   row.at("tremor") * std::sin(row.at("pace") * t));
  input.stiffness = row.at("spring");
  input.position = row.at("lead") + row.at("speed") * t;
  return input;
}

TEST(PlungerModel, ForcePressureFlowAndVolumesAreTheIndependentModelsForAnySyringe) {
  constexpr double kTick = 1e-3;  // s
  constexpr std::array<const char*, 5> kNames{"travel", "volume", "flow", "pressure", "force"};
  const std::vector<OracleCase> rows = read_rows();
  ASSERT_GE(rows.size(), 200U);
  std::array<double, 5> worst{};
  for (std::size_t n = 0; n < rows.size(); ++n) {
    const OracleCase& row = rows[n];
    Plunger plunger(params_of(row), places_of(row), kTick);
    std::array<double, 5> greatest{};
    for (std::size_t i = 0; i < kNames.size(); ++i)
      for (const char* k : {"0", "1", "2"})
        greatest[i] = std::max(greatest[i], std::abs(row.at(kNames[i] + std::string(k))));
    int tick = 0;
    for (const char* k : {"0", "1", "2"}) {
      while (tick * kTick < row.at(std::string("time") + k) - kTick / 2) {
        ++tick;
        plunger.step(thumb_at(row, tick * kTick));
      }
      const PlungerState& s = plunger.state();
      const std::array<double, 5> ours{s.travel, plunger.states()[0].volume, s.flow, s.pressure,
                                       s.force};
      for (std::size_t i = 0; i < kNames.size(); ++i) {
        const double apart = std::abs(ours[i] - row.at(kNames[i] + std::string(k))) / greatest[i];
        worst[i] = std::max(worst[i], apart);
        EXPECT_LT(apart, 1e-3) << kNames[i] << ' ' << k << " of row " << n;
      }
    }
  }
  for (std::size_t i = 0; i < kNames.size(); ++i)
    std::printf("%-8s worst %.1e of the greatest in its case\n", kNames[i], worst[i]);
}

}  // namespace
}  // namespace artus
