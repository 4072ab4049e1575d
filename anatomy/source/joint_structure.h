// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <vector>

#include "artus/anatomy/joint_file.h"
#include "artus/detail/core/toml_table.h"

namespace artus {

/// The structures a construct leans on by name; empty for a surface.
[[nodiscard]] std::vector<std::string> names_of(const Structure& structure);

/// m per "mm", "cm" or "m"; a problem of `toml` (and 1e-3) when it is something else.
double length_unit(TomlTable& toml, std::string_view key, double default_unit);

/// One [[structure]].
[[nodiscard]] Structure read_structure(const toml::table& table, std::size_t number, double unit,
                                       Problems& problems);

/// The [body].
[[nodiscard]] Structure read_body(const toml::table& table, double unit, std::string& filler_name,
                                  Problems& problems);

/// The [partition.NAME] tables, by name.
[[nodiscard]] std::vector<Partition> read_partitions(TomlTable& toml, double unit);

/// What can be said only when all structures are known: unique names, known tissues and partitions,
/// constructs that name structures of the file and do not run in a circle.
void check_structures(const JointFile& joint, const std::vector<toml::source_region>& places,
                      Problems& problems);

}  // namespace artus
