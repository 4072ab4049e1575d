// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstdint>
#include <cstdio>
#include <string>

namespace artus {

/// What printf would print of numbers and C strings, of any length; empty for a pattern that it
/// refuses.
template <class... Values>
[[nodiscard]] std::string printed(const char* pattern, Values... values) {
  const int size = std::snprintf(nullptr, 0, pattern, values...);
  std::string text(size > 0 ? static_cast<std::size_t>(size) : 0, '\0');
  if (size > 0) static_cast<void>(std::snprintf(text.data(), text.size() + 1, pattern, values...));
  return text;
}

/// Sixteen hexadecimal digits.
[[nodiscard]] inline std::string in_hexadecimal(std::uint64_t value) {
  return printed("%016llx", static_cast<unsigned long long>(value));
}

}  // namespace artus
