// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <string>
#include <utility>

#include <tl/expected.hpp>

namespace artus {

/// What kind of thing is wrong with the world (a file, a flag, a peer), for exit codes and tests.
enum class ErrorCode {
  not_found,    ///< a file, structure or name that does not exist
  unreadable,   ///< exists, but cannot be opened, read or written
  malformed,    ///< syntax or structure of the content is wrong
  invalid,      ///< well formed, but the values make no sense
  unsupported,  ///< a format, version or feature this build does not know
  corrupt,      ///< checksum or length does not agree with the content
  defective,    ///< a surface that cannot be repaired safely
  failed        ///< an algorithm gave up; the message says at what
};

/// A refusal: what is wrong, where it is wrong, and (in the message) what to do about it.
struct Error {
  ErrorCode code{};
  std::string message;  ///< one sentence for a person: what and what to do
  std::string where;    ///< file, file:line, structure name or flag; may be empty

  /// "where: message", the form that is printed.
  [[nodiscard]] std::string to_string() const {
    return where.empty() ? message : where + ": " + message;
  }
};

/// The stable lower-case name of a code, as JSON output prints it.
[[nodiscard]] const char* to_string(ErrorCode code) noexcept;

/// A value, or the reason why there is none. The world's failures travel this way; a caller's
/// mistakes are ARTUS_REQUIRE and our own are ARTUS_ASSERT (core/check.h).
template <class T>
using Result = tl::expected<T, Error>;

/// Makes the failed form of any Result: `return fail(ErrorCode::malformed, "...", path);`.
[[nodiscard]] inline tl::unexpected<Error> fail(ErrorCode code, std::string message,
                                                std::string where = {}) {
  return tl::unexpected<Error>(Error{code, std::move(message), std::move(where)});
}

}  // namespace artus

/// Hands a failure on: returns the error of `result`, a Result of any type or an expression that
/// gives one, from a function that returns a Result. A successful one is left as it is.
#define ARTUS_TRY(...)                                                        \
  do {                                                                        \
    if (auto&& artus_result = (__VA_ARGS__); !artus_result)                   \
      return tl::unexpected<::artus::Error>(std::move(artus_result).error()); \
  } while (false)
