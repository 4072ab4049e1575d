// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace artus {

/// The languages of window and reports. English sentences stand in the code; the others are in
/// po/<language>.po and are built into this library.
enum class Language { english, french };
/// "en" or "fr", as a flag or the first letters of a locale; empty for another.
[[nodiscard]] std::optional<Language> find_language(std::string_view name) noexcept;

/// Marks an English sentence that is translated elsewhere: scripts/update-po finds it.
[[nodiscard]] constexpr const char* msgid(const char* english) noexcept {
  return english;
}

/// The sentence in a language; as it is where the catalogue has no such sentence. Lives as long as
/// `english` and the program. Cost: one binary search, no allocation.
[[nodiscard]] const char* translate(Language language, const char* english) noexcept;
/// The same for a word that means several things: `context` ("anatomy") tells which.
[[nodiscard]] const char* translate_in(Language language, const char* context, const char* english);
/// The sentence for so many of something, by the language's plural rule.
[[nodiscard]] const char* translate_count(Language language, const char* one, const char* many,
                                          long count) noexcept;

/// A text whose {} are replaced in order.
[[nodiscard]] std::string fill(std::string_view pattern, std::span<const std::string_view> values);
[[nodiscard]] std::string fill(std::string_view pattern,
                               std::initializer_list<std::string_view> values);
/// A number with so many decimals and the language's decimal sign.
[[nodiscard]] std::string number(Language language, double value, int decimals);

}  // namespace artus
