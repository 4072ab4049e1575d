// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "artus/detail/echo/display/scan_converter.h"
#include "artus/echo/frame.h"
#include "artus/echo/image_settings.h"

namespace artus {

/// A frame's velocities as a picture (height, width), x fastest: 0 where nothing moves, else -limit
/// to limit as 1 to 255. `settings`: those of the frame. Requires: the frame has velocities.
[[nodiscard]] std::vector<std::uint8_t> motion_picture(const Frame& frame,
                                                       const ScanConverter& converter,
                                                       const ImageSettings& settings);
/// Red, green, blue of one of its levels but 0: red toward the probe, blue away, brighter is
/// faster.
[[nodiscard]] std::array<std::uint8_t, 3> motion_colour(std::uint8_t level) noexcept;

}  // namespace artus
