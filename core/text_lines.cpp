// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/core/text_lines.h"

#include <algorithm>

namespace artus {

Result<void> for_lines(
    std::string_view text, const std::string& name,
    const std::function<Result<void>(std::string_view line, const std::string& where)>& each) {
  constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
  if (text.substr(0, kByteOrderMark.size()) == kByteOrderMark)
    text.remove_prefix(kByteOrderMark.size());
  std::size_t number = 0;
  while (!text.empty()) {
    ++number;
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    while (!line.empty() && (line.back() == '\r' || line.back() == ' ')) line.remove_suffix(1);
    if (line.empty()) continue;
    ARTUS_TRY(each(line, name + ":" + std::to_string(number)));
  }
  return {};
}

std::string_view trimmed(std::string_view text) noexcept {
  constexpr std::string_view kBlank(" \t\r\n\0", 5);
  const std::size_t first = text.find_first_not_of(kBlank);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlank) - first + 1);
}

}  // namespace artus
