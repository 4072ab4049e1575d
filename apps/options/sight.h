// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "artus/detail/apps/options/view_options.h"
#include "artus/echo/renderer.h"

namespace artus {

/// Whether a frame shows anything at all. Errors: invalid when no element of the probe touches
/// skin; the message says where the nearest skin is and the --probe that stands there.
[[nodiscard]] Result<void> check_sight(const Frame& frame, const LoadedView& view);

/// What people should know of where the probe's face stands, a line each: wholly off the skin, with
/// gel in the gap, or inside the body. Empty: it stands on skin. Cost: of five lines.
[[nodiscard]] std::vector<std::string> notes_of_stand(const LoadedView& view);

}  // namespace artus
