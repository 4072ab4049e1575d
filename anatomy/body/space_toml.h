// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <string_view>
#include <vector>

#include "artus/detail/anatomy/body/space.h"
#include "artus/detail/core/toml_table.h"

namespace artus {

/// Takes the keys of a space's law over into `law`. What is wrong goes to the problems of `toml`; a
/// law that `is_new` must name its kind.
void read_space_law(TomlTable& toml, bool is_new, SpaceLaw& law);

/// The profile of that name; null: there is none.
[[nodiscard]] const SpaceProfile* find_profile(const std::vector<SpaceProfile>& profiles,
                                               std::string_view name);

}  // namespace artus
