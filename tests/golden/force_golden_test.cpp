// SPDX-License-Identifier: AGPL-3.0-or-later
// The force traces of the scenarios against the committed ones: every column, the layers, states
// and events too, to 1e-6. Re-make them with scripts/regenerate-goldens.
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <set>

#include <gtest/gtest.h>

#include "artus/detail/core/text_file.h"
#include "tests/golden/force_scenarios.h"
#include "tests/support/paths.h"

namespace artus {
namespace {

const std::filesystem::path kFile =
    artus::test::source_dir() / "tests/golden/expected/force-scenarios.csv";
const std::filesystem::path kOutput = ARTUS_GOLDEN_OUTPUT;

/// Lines of the file that belong to a scenario, without its name; the header first.
std::vector<std::string> read_expected(const std::string& scenario) {
  std::ifstream in(kFile);
  std::vector<std::string> lines;
  std::string line;
  while (std::getline(in, line)) {
    const std::size_t comma = line.find(',');
    if (lines.empty() || line.substr(0, comma) == scenario) lines.push_back(line.substr(comma + 1));
  }
  return lines;
}

TEST(ForceGolden, EveryColumnOfEveryScenarioIsTheCommittedOne) {
  const bool updating = std::getenv("ARTUS_UPDATE_GOLDENS") != nullptr;
  std::string all;
  bool good = true;
  for (const test::ForceScenario& scenario : test::make_force_scenarios()) {
    const auto actual = test::trace_lines(scenario, scenario.setup);
    const std::string difference = test::find_difference(read_expected(scenario.name), actual);
    std::cout << "golden force " << scenario.name << ": "
              << (difference.empty() ? "as committed" : difference) << '\n';
    EXPECT_TRUE(updating || difference.empty()) << scenario.name << ": " << difference;
    good = good && difference.empty();
    if (all.empty()) all = "scenario," + actual.front() + '\n';
    for (std::size_t i = 1; i < actual.size(); ++i) all += scenario.name + ',' + actual[i] + '\n';
  }
  if (updating) {
    ASSERT_TRUE(write_text(kFile, all));
  } else if (!good) {
    ASSERT_TRUE(write_text(kOutput / "force-scenarios.csv", all));
  }
}

TEST(ForceScenarios, ReachEveryStateEventAndStatusThereIs) {
  std::set<ContactState> states;
  std::uint32_t events = 0;
  std::uint32_t status = 0;
  for (const test::ForceScenario& scenario : test::make_force_scenarios()) {
    for (const NeedleRow& row : scenario.run(scenario.setup)) {
      states.insert(row.state);
      events |= row.events;
      status |= row.status;
    }
  }
  EXPECT_EQ(states.size(), static_cast<std::size_t>(ContactState::bone) + 1);
  EXPECT_EQ(events, ContactEvent::kSkinPunctured | ContactEvent::kMembranePopped |
                        ContactEvent::kRedirected | ContactEvent::kBoneTouched |
                        ContactEvent::kExited | ContactEvent::kAdopted);
  EXPECT_EQ(status & (TickStatus::kTeleport | TickStatus::kStale | TickStatus::kOutOfWorkspace |
                      TickStatus::kRamping | TickStatus::kSlewLimited | TickStatus::kSaturated),
            TickStatus::kTeleport | TickStatus::kStale | TickStatus::kOutOfWorkspace |
                TickStatus::kRamping | TickStatus::kSlewLimited | TickStatus::kSaturated);
}

}  // namespace
}  // namespace artus
