// SPDX-License-Identifier: AGPL-3.0-or-later
// The scenarios' traces as text, and how two of them differ.
#include <algorithm>
#include <cmath>

#include "artus/detail/core/text_cursor.h"
#include "tests/golden/force_scenarios.h"

namespace artus::test {
namespace {

bool happens(const NeedleRow& row, const NeedleRow& before) {
  return row.events != 0 || row.state != before.state || row.status != before.status ||
         row.region != before.region;
}

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  for (std::size_t from = 0; from <= text.size();) {
    const std::size_t to = std::min(text.find(separator, from), text.size());
    parts.push_back(text.substr(from, to - from));
    from = to + 1;
  }
  return parts;
}

/// Whether two cells are the same number within the tolerance, or the same word.
bool same(const std::string& a, const std::string& b) {
  constexpr double kTolerance = 1e-6;
  if (a == b) return true;
  const auto x = parse_number(a);
  const auto y = parse_number(b);
  return x && y && std::abs(*x - *y) <= kTolerance * std::max(1.0, std::abs(*x));
}

}  // namespace

std::vector<std::string> trace_lines(const ForceScenario& scenario, const ForceSetup& setup) {
  constexpr std::size_t kStride = 25;
  const std::vector<NeedleRow> rows = scenario.run(setup);
  std::vector<NeedleRow> kept;
  for (std::size_t i = 0; i < rows.size(); ++i)
    if (i % kStride == 0 || happens(rows[i], rows[i - 1])) kept.push_back(rows[i]);
  std::vector<std::string> lines{needle_csv_header()};
  for (const NeedleRow& row : kept) lines.push_back(needle_csv_line(row, scenario_region_names()));
  return lines;
}

std::string find_difference(const std::vector<std::string>& expected,
                            const std::vector<std::string>& actual) {
  if (expected.empty() || actual.empty() || expected[0] != actual[0]) return "other columns";
  const auto names = split(expected[0], ',');
  for (std::size_t i = 1; i < std::min(expected.size(), actual.size()); ++i) {
    const auto a = split(expected[i], ',');
    const auto b = split(actual[i], ',');
    if (a.size() != b.size()) return "row " + std::to_string(i) + ": other columns";
    for (std::size_t c = 0; c < a.size(); ++c)
      if (!same(a[c], b[c]))
        return "row " + std::to_string(i) + ", " + names[c] + ": " + a[c] + " -> " + b[c];
  }
  if (expected.size() == actual.size()) return {};
  return std::to_string(expected.size()) + " -> " + std::to_string(actual.size()) + " rows";
}

}  // namespace artus::test
