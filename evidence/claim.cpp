// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/evidence/claim.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include <nlohmann/json.hpp>

#include "artus/core/csv.h"

namespace artus {
namespace {
std::string with_unit(double value, const std::string& unit) {
  return to_csv(value) + (unit.empty() ? "" : " " + unit);
}
}  // namespace

Claim claim_at_most(std::string text, double value, double limit, const std::string& unit) {
  return {std::move(text), value, "<= " + with_unit(limit, unit), value <= limit};
}

Claim claim_at_least(std::string text, double value, double limit, const std::string& unit) {
  return {std::move(text), value, ">= " + with_unit(limit, unit), value >= limit};
}

Claim claim_near(std::string text, double value, double expected, double share,
                 const std::string& unit) {
  return {std::move(text), value, with_unit(expected, unit) + " +- " + to_csv(100 * share) + " %",
          std::abs(value - expected) <= share * std::abs(expected)};
}

Claim claim_within(std::string text, double value, double expected, double tolerance,
                   const std::string& unit) {
  return {std::move(text), value, to_csv(expected) + " +- " + with_unit(tolerance, unit),
          std::abs(value - expected) <= tolerance};
}

std::string to_markdown(const std::vector<Claim>& claims) {
  std::string table = "| claim | value | bound | holds |\n|---|---|---|---|\n";
  for (const Claim& claim : claims) {
    char value[32];
    std::snprintf(value, sizeof value, "%.4g", claim.value);
    table += "| " + claim.text + " | " + value + " | " + claim.bound + " | " +
             (claim.pass ? "yes" : "**no**") + " |\n";
  }
  return table;
}

nlohmann::json verdict(const std::vector<Claim>& claims) {
  nlohmann::json list = nlohmann::json::array();
  for (const Claim& c : claims) {
    list.push_back({{"claim", c.text}, {"value", c.value}, {"bound", c.bound}, {"pass", c.pass}});
  }
  const bool pass =
      std::all_of(claims.begin(), claims.end(), [](const Claim& c) { return c.pass; });
  return {{"pass", pass}, {"claims", list}};
}

}  // namespace artus
