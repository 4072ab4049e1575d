// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <filesystem>
#include <span>
#include <string>

#include "artus/core/result.h"

namespace artus {

/// Pictures of files beside each other on one, a name above each. Errors: not_found, unreadable.
[[nodiscard]] Result<void> write_plate(std::span<const std::filesystem::path> pictures,
                                       std::span<const std::string> names,
                                       const std::filesystem::path& file);

}  // namespace artus
