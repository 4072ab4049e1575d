// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

namespace artus {

/// A table for people and programs: a header and rows of text cells.
struct TextTable {
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows;
};

/// CSV text; a cell with a comma, a quote or a line break is quoted.
[[nodiscard]] std::string to_csv_text(const TextTable& table);

/// A Markdown table; empty when the header is.
[[nodiscard]] std::string to_markdown(const TextTable& table);

/// A number with so many digits after the point, for people: "0.65 s".
[[nodiscard]] std::string fixed(double value, int digits, const std::string& unit = {});

}  // namespace artus
