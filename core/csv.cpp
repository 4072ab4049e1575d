// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/core/csv.h"

#include <array>
#include <charconv>

#include "artus/detail/core/text_lines.h"

namespace artus {
namespace {

std::string with_digits(double value, int digits) {
  std::array<char, 40> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value,
                                 std::chars_format::general, digits);
  return {text.data(), end.ptr};
}

}  // namespace

std::string to_csv(double value) {
  return with_digits(value == 0 ? 0.0 : value, 9);
}

std::string to_exact_csv(double value) {
  return with_digits(value, 17);
}

std::vector<std::string> csv_cells(std::string_view line) {
  std::vector<std::string> cells;
  for (;;) {
    const std::size_t comma = line.find(',');
    cells.emplace_back(trimmed(line.substr(0, comma)));
    if (comma == std::string_view::npos) return cells;
    line.remove_prefix(comma + 1);
  }
}

std::string quoted_csv(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"') out += '"';
    out += c;
  }
  return out + '"';
}

}  // namespace artus
