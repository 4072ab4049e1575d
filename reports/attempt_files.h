// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <filesystem>

#include <nlohmann/json.hpp>

#include "artus/detail/training/player.h"

namespace artus {

/// Marks, score and all numbers of an attempt, as attempt.json has them.
[[nodiscard]] nlohmann::json to_json(const Scenario& scenario, const PlayedAttempt& attempt);

/// scenario.toml and attempt.json in an attempt's folder, where its recording is. Errors: those of
/// write_text.
[[nodiscard]] Result<void> write_attempt_files(const Scenario& scenario,
                                               const PlayedAttempt& attempt,
                                               const std::filesystem::path& folder);

}  // namespace artus
