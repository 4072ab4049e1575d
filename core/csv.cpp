// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/core/csv.h"

#include <array>
#include <charconv>

namespace artus {

std::string to_csv(double value) {
  constexpr int kDigits = 9;
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value == 0 ? 0.0 : value,
                                 std::chars_format::general, kDigits);
  return {text.data(), end.ptr};
}

}  // namespace artus
