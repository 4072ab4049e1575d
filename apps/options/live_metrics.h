// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <filesystem>
#include <memory>

#include "artus/detail/apps/options/command_line.h"
#include "artus/detail/training/live_attempt.h"

namespace artus {

/// Adds --metrics to a command that runs a session.
void add_live_metrics_option(Command* command, std::filesystem::path& file);

/// What measures a session while it runs; null when `file` is empty. Errors: unreadable, when
/// `file` cannot be written; it is tried here, before anyone works for nothing.
[[nodiscard]] Result<std::unique_ptr<LiveAttempt>> make_live_meter(
    const std::filesystem::path& file, const std::shared_ptr<const Scene>& scene,
    const SessionParams& params);

/// Writes the numbers; says on stderr when they are those of the session's beginning alone.
/// Requires: the session is over. Errors: as write_text.
[[nodiscard]] Result<void> write_live_metrics(const std::filesystem::path& file,
                                              LiveAttempt* meter);

}  // namespace artus
