// SPDX-License-Identifier: AGPL-3.0-or-later
#include "tests/mutations/mutations.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "artus/detail/core/text_file.h"

namespace artus::test {

namespace {
constexpr const char* kTable = "ARTUS_MUTATION_TABLE";
}  // namespace

bool wants_table() {
  return std::getenv(kTable) != nullptr;
}

void expect_noticed(const std::string& what, const std::vector<Mutation>& mutations,
                    const Exempt& exempt) {
  nlohmann::ordered_json table;
  for (const Mutation& m : mutations) {
    const auto excuse = exempt.find(m.parameter);
    std::cout << what << ' ' << m.parameter << ": "
              << (m.noticed_by.empty() ? "NOT NOTICED" : m.first_difference) << " ("
              << m.noticed_by.size() << " in all)\n";
    table[m.parameter] = {{"noticed_by", m.noticed_by}, {"first", m.first_difference}};
    if (excuse == exempt.end()) {
      EXPECT_FALSE(m.noticed_by.empty()) << m.parameter << " may change by 5 % unnoticed";
    } else {
      table[m.parameter]["exempt"] = excuse->second;
      EXPECT_TRUE(m.noticed_by.empty()) << m.parameter << " is noticed: it needs no excuse";
    }
  }
  const char* file = std::getenv(kTable);
  if (file == nullptr) return;
  nlohmann::ordered_json all;
  if (std::ifstream in(file); in.peek() != std::ifstream::traits_type::eof())
    all = nlohmann::ordered_json::parse(in);
  all[what] = table;
  ASSERT_TRUE(write_text(file, all.dump(1) + "\n"));
}

}  // namespace artus::test
