// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/viewer/words/translation.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>

#include "artus/detail/viewer/words/fr_mo.h"

namespace artus {
namespace {

/// A catalogue as msgfmt writes it, searched where it lies in the program (GNU gettext manual, "The
/// Format of GNU MO Files"): a head of 32-bit words, then two tables of {length, offset}, of the
/// sorted English texts and of their translations. Each text ends with a zero byte.
class Catalogue {
 public:
  explicit constexpr Catalogue(std::span<const unsigned char> bytes) : bytes_(bytes) {}

  /// Null for an English text that is not in it.
  [[nodiscard]] const char* find(std::string_view english) const noexcept {
    std::uint32_t from = 0;
    std::uint32_t to = word(8);
    while (from < to) {
      const std::uint32_t middle = from + (to - from) / 2;
      const int order = english.compare(text(word(12), middle));
      if (order == 0) return text(word(16), middle);
      (order < 0 ? to : from) = order < 0 ? middle : middle + 1;
    }
    return nullptr;
  }

 private:
  [[nodiscard]] std::uint32_t word(std::size_t at) const noexcept {
    return bytes_[at] | std::uint32_t{bytes_[at + 1]} << 8U | std::uint32_t{bytes_[at + 2]} << 16U |
           std::uint32_t{bytes_[at + 3]} << 24U;
  }
  [[nodiscard]] const char* text(std::uint32_t table, std::uint32_t row) const noexcept {
    return reinterpret_cast<const char*>(bytes_.data() + word(table + 8 * std::size_t{row} + 4));
  }

  std::span<const unsigned char> bytes_;
};

const char* find_french(std::string_view english) noexcept {
  return english.empty() ? nullptr : Catalogue(kFrenchCatalogue).find(english);
}

}  // namespace

std::optional<Language> find_language(std::string_view name) noexcept {
  if (name.substr(0, 2) == "fr") return Language::french;
  if (name.substr(0, 2) == "en") return Language::english;
  return std::nullopt;
}

const char* translate(Language language, const char* english) noexcept {
  if (language == Language::english) return english;
  const char* french = find_french(english);
  return french != nullptr ? french : english;
}

const char* translate_in(Language language, const char* context, const char* english) {
  if (language == Language::english) return english;
  const char* french = find_french(std::string(context) + '\4' + english);
  return french != nullptr ? french : english;
}

const char* translate_count(Language language, const char* one, const char* many,
                            long count) noexcept {
  const bool plural = language == Language::french ? count > 1 : count != 1;
  const char* french = language == Language::french ? find_french(one) : nullptr;
  if (french == nullptr) return plural ? many : one;
  return plural ? french + std::string_view(french).size() + 1 : french;
}

std::string fill(std::string_view pattern, std::span<const std::string_view> values) {
  std::string out;
  for (const std::string_view value : values) {
    const std::size_t at = pattern.find("{}");
    if (at == std::string_view::npos) break;
    out += pattern.substr(0, at);
    out += value;
    pattern.remove_prefix(at + 2);
  }
  out += pattern;
  return out;
}

std::string fill(std::string_view pattern, std::initializer_list<std::string_view> values) {
  return fill(pattern, std::span(values.begin(), values.size()));
}

std::string number(Language language, double value, int decimals) {
  std::array<char, 48> digits{};
  std::snprintf(digits.data(), digits.size(), "%.*f", decimals, value);
  std::string shown(digits.data());
  if (shown.find_first_not_of("-0.") == std::string::npos && shown[0] == '-') shown.erase(0, 1);
  if (language == Language::french) std::replace(shown.begin(), shown.end(), '.', ',');
  return shown;
}

}  // namespace artus
