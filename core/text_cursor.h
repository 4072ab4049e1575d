// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "artus/core/result.h"

namespace artus {

/// Walks over text token by token and knows the line it is at. Never depends on the locale, never
/// copies. A token is a run of characters above space.
class TextCursor {
 public:
  TextCursor(std::string_view text, std::string name, std::size_t first_line = 1)
      : text_(text), name_(std::move(name)), line_(first_line) {}

  /// The next token of the whole text; empty at its end.
  std::string_view next();
  /// The next token of the current line; empty at the line's end.
  std::string_view next_in_line();
  /// Goes on behind the end of the current line.
  void skip_line();
  [[nodiscard]] bool at_end() const noexcept { return position_ >= text_.size(); }
  [[nodiscard]] std::size_t line() const noexcept { return line_; }
  [[nodiscard]] std::size_t position() const noexcept { return position_; }
  [[nodiscard]] std::size_t remaining() const noexcept { return text_.size() - position_; }

  /// The next token as a number; nullopt when it is none (or the text is at its end).
  std::optional<double> next_number();
  /// The next token as a whole number.
  std::optional<std::int64_t> next_integer();

  /// "name:line", for Error::where.
  [[nodiscard]] std::string where() const { return name_ + ":" + std::to_string(line_); }
  /// The error of a token that should be a number, at the current line.
  [[nodiscard]] tl::unexpected<Error> not_a_number(std::string_view token) const;
  /// A malformed-file error at the current line.
  [[nodiscard]] tl::unexpected<Error> malformed(std::string message) const {
    return fail(ErrorCode::malformed, std::move(message), where());
  }

 private:
  std::string_view take_token();

  std::string_view text_;
  std::string name_;
  std::size_t position_ = 0;
  std::size_t line_ = 1;
};

/// A decimal number with a point, whatever the locale; "nan", "inf" and a leading plus are taken.
/// Too large becomes infinite, too small zero. nullopt when the text is anything else.
[[nodiscard]] std::optional<double> parse_number(std::string_view text) noexcept;
[[nodiscard]] std::optional<std::int64_t> parse_integer(std::string_view text) noexcept;

/// Appends the shortest decimal that reads back to the same double.
void append_number(std::string& out, double value);

/// A number with so many decimals, as tables of a page have it.
[[nodiscard]] std::string fixed_number(double value, int decimals);

/// A token as it may stand in a message: in quotes, shortened, unprintable bytes as '?'.
[[nodiscard]] std::string quoted(std::string_view token);

}  // namespace artus
