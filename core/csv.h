// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace artus {

/// A number with nine significant digits, '.' as decimal point in any locale.
[[nodiscard]] std::string to_csv(double value);
/// A number with seventeen: the same double again when it is read.
[[nodiscard]] std::string to_exact_csv(double value);
/// What stands between the commas of a line, trimmed; quotes have no meaning here.
[[nodiscard]] std::vector<std::string> csv_cells(std::string_view line);
/// Text as one field: in quotes, its own doubled.
[[nodiscard]] std::string quoted_csv(std::string_view text);

}  // namespace artus
