// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <functional>
#include <string>
#include <string_view>

#include "artus/detail/core/toml_table.h"

namespace artus {

/// Takes one table of a library, [GROUP.NAME]; what does not fit goes to the problems.
using EntryReader =
    std::function<void(const std::string& name, const toml::table& table, Problems& problems)>;

/// Gives `read` the tables in `entries` in the order of their file (toml++ keeps them by name). One
/// that is no table, or whose name is not of [a-z0-9_], is a problem and is left out.
void read_entries(const toml::table& entries, const std::string& group, Problems& problems,
                  const EntryReader& read);

/// A library file: `format = 1` and tables [GROUP.NAME], in the order of the file. `name` is the
/// file's in messages. Errors: malformed (with line), invalid with all problems at once.
[[nodiscard]] Result<void> parse_library(std::string_view text, const std::string& name,
                                         const std::string& group, const EntryReader& read);

}  // namespace artus
