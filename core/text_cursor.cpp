// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/core/text_cursor.h"

#include <array>
#include <charconv>
#include <limits>

namespace artus {
namespace {

bool is_blank(char c) noexcept {
  return static_cast<unsigned char>(c) <= ' ';
}

std::string_view without_plus(std::string_view text) noexcept {
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  return text;
}

}  // namespace

std::string_view TextCursor::take_token() {
  const std::size_t start = position_;
  while (position_ < text_.size() && !is_blank(text_[position_])) ++position_;
  return text_.substr(start, position_ - start);
}

std::string_view TextCursor::next() {
  while (position_ < text_.size() && is_blank(text_[position_])) {
    if (text_[position_] == '\n') ++line_;
    ++position_;
  }
  return take_token();
}

std::string_view TextCursor::next_in_line() {
  while (position_ < text_.size() && is_blank(text_[position_]) && text_[position_] != '\n')
    ++position_;
  return take_token();
}

void TextCursor::skip_line() {
  const auto end = text_.find('\n', position_);
  if (end == std::string_view::npos) {
    position_ = text_.size();
  } else {
    position_ = end + 1;
    ++line_;
  }
}

std::optional<double> TextCursor::next_number() {
  return parse_number(next());
}
std::optional<std::int64_t> TextCursor::next_integer() {
  return parse_integer(next());
}

std::optional<double> parse_number(std::string_view text) noexcept {
  text = without_plus(text);
  if (text.empty()) return std::nullopt;
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (end != text.data() + text.size()) return std::nullopt;
  if (error == std::errc{}) return value;
  if (error != std::errc::result_out_of_range) return std::nullopt;
  const auto exponent = text.find_first_of("eE");
  const bool tiny = exponent == std::string_view::npos
                        ? text.find('.') != std::string_view::npos && text.find('.') < 300
                        : text.substr(exponent + 1).starts_with('-');
  if (tiny) return 0.0;
  const double huge = std::numeric_limits<double>::infinity();
  return text.starts_with('-') ? -huge : huge;
}

std::optional<std::int64_t> parse_integer(std::string_view text) noexcept {
  text = without_plus(text);
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (text.empty() || error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

void append_number(std::string& out, double value) {
  std::array<char, 32> buffer{};
  const auto result = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  out.append(buffer.data(), result.ptr);
}

std::string quoted(std::string_view token) {
  constexpr std::size_t kLongest = 40;
  std::string out = "'";
  for (const char c : token.substr(0, kLongest)) out += (c < ' ' || c > '~') ? '?' : c;
  if (token.size() > kLongest) out += "...";
  return out + "'";
}

std::string fixed_number(double value, int decimals) {
  std::array<char, 400> text{};
  static_cast<void>(std::snprintf(text.data(), text.size(), "%.*f", decimals, value));
  return text.data();
}

tl::unexpected<Error> TextCursor::not_a_number(std::string_view token) const {
  const bool has_comma = token.find(',') != std::string_view::npos;
  return malformed(quoted(token) + " is not a number" +
                   (has_comma ? " (decimals take a point, not a comma)" : ""));
}

}  // namespace artus
