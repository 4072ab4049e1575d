// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <string>
#include <string_view>

namespace artus {

/// What an exception says, for people: without the mark that a library puts before it, as
/// "[json.exception.type_error.302] ".
[[nodiscard]] inline std::string plain_reason(std::string_view what) {
  const auto end = what.find("] ");
  if (what.substr(0, 1) == "[" && end != std::string_view::npos) what.remove_prefix(end + 2);
  return std::string(what);
}

}  // namespace artus
