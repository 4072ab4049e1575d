// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <functional>
#include <string>
#include <string_view>

#include "artus/core/result.h"

namespace artus {

/// Calls `each(line, where)` for every line that is not blank, without what ends it and without a
/// byte order mark before the first; `where` is "name:number", as messages tell a place. Errors: of
/// `each`, at which it ends.
[[nodiscard]] Result<void> for_lines(
    std::string_view text, const std::string& name,
    const std::function<Result<void>(std::string_view line, const std::string& where)>& each);

/// Without the spaces, tabs, ends of lines and NULs around it; a view of the same characters.
[[nodiscard]] std::string_view trimmed(std::string_view text) noexcept;

}  // namespace artus
