// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace artus {

/// A number with nine significant digits, '.' as decimal point in any locale.
[[nodiscard]] std::string to_csv(double value);

/// A table for people and programs: a header and rows of text cells.
struct TextTable {
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows;
};

}  // namespace artus
