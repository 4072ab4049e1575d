// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <set>
#include <string>
#include <vector>

#include "artus/detail/anatomy/body/space.h"
#include "artus/detail/core/toml_table.h"

namespace artus {

/// The [[space]] tables of a joint file, each on top of the profile that it is `like`. `regions`:
/// the structures there are. A structure in two spaces, a leak to nowhere and so on are problems.
/// Errors: those of the bundled profiles and liquids.
[[nodiscard]] Result<std::vector<Space>> read_spaces(
    TomlTable& toml, const std::set<std::string, std::less<>>& regions);

}  // namespace artus
