// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <filesystem>
#include <string>

#include "artus/detail/training/health/body_health.h"

namespace artus {

/// Draws the two bodies of a question, NAME-before.png and NAME-after.png in `folder` (made when
/// missing): B-mode above the labels, without the needle. Errors: unreadable. Cost: two Renderers.
[[nodiscard]] Result<void> write_body_pictures(const HealthQuestion& question,
                                               const std::filesystem::path& folder,
                                               const std::string& name);

}  // namespace artus
