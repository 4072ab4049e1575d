// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <string>
#include <string_view>

namespace artus {

/// Text as HTML and SVG show it, in elements and in quoted attributes: &, <, > and " are replaced.
[[nodiscard]] std::string escape_markup(std::string_view text);

}  // namespace artus
