// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "artus/detail/anatomy/body/tissue.h"
#include "artus/detail/core/toml_table.h"

namespace artus {

/// Merges a [tissue] table into `tissues`: a known tissue is overridden value by value, an unknown
/// one is appended and must be complete. `default_source` is the source of overridden groups that
/// name none; empty: a group must name its own.
void merge_tissues(const toml::table& table, const std::string& default_source,
                   std::vector<Tissue>& tissues, Problems& problems);

}  // namespace artus
