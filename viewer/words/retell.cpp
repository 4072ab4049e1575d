// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/viewer/words/retell.h"

#include <algorithm>
#include <optional>
#include <string_view>
#include <vector>

#include "artus/detail/viewer/words/anatomy_names.h"

namespace artus {
namespace {

/// What stands in a pattern's places when a text is of its form.
std::optional<std::vector<std::string>> match(std::string_view pattern, std::string_view text) {
  const std::size_t place = pattern.find("{}");
  const std::string_view before = pattern.substr(0, place);
  if (text.substr(0, before.size()) != before) return std::nullopt;
  text.remove_prefix(before.size());
  if (place == std::string_view::npos)
    return text.empty() ? std::optional(std::vector<std::string>()) : std::nullopt;
  const std::string_view rest = pattern.substr(place + 2);
  const std::string_view next = rest.substr(0, rest.find("{}"));
  for (std::size_t end = 0; end <= text.size(); ++end) {
    if (text.substr(end, next.size()) != next) continue;
    auto later = match(rest, text.substr(end));
    if (!later) continue;
    later->insert(later->begin(), std::string(text.substr(0, end)));
    return later;
  }
  return std::nullopt;
}

bool is_number(const std::string& text) {
  return !text.empty() && text.find_first_not_of("0123456789.-") == std::string::npos;
}

std::string retell_place(Language language, std::span<const char* const> patterns,
                         const std::string& english) {
  if (!is_number(english)) {
    const std::string told = retell(language, patterns, english);
    return told == english ? known_name(language, english).value_or(english) : told;
  }
  std::string digits = english;
  std::replace(digits.begin(), digits.end(), '.', ',');
  return digits;
}

}  // namespace

std::string retell(Language language, std::span<const char* const> patterns,
                   const std::string& english) {
  if (language == Language::english) return english;
  for (const char* pattern : patterns) {
    auto places = match(pattern, english);
    if (!places) continue;
    for (std::string& place : *places) place = retell_place(language, patterns, place);
    const std::vector<std::string_view> values(places->begin(), places->end());
    return fill(translate(language, pattern), values);
  }
  return english;
}

}  // namespace artus
