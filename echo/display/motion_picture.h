// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "artus/detail/echo/display/scan_converter.h"
#include "artus/echo/frame.h"
#include "artus/echo/image_settings.h"

namespace artus {

/// What moves in a frame as a picture (height, width), x fastest: 0 where nothing does, else 1 to
/// 255: velocities from -limit to limit, or powers from -70 to -30 dB (assumed). `settings`: those
/// of the frame. Requires: the frame has velocities; `shown` is not none.
[[nodiscard]] std::vector<std::uint8_t> motion_picture(const Frame& frame,
                                                       const ScanConverter& converter,
                                                       const ImageSettings& settings,
                                                       MotionShown shown = MotionShown::velocity);
/// Red, green, blue of one of its levels but 0: red toward the probe, blue away, brighter is
/// faster; of powers dark red to yellow.
[[nodiscard]] std::array<std::uint8_t, 3> motion_colour(
    std::uint8_t level, MotionShown shown = MotionShown::velocity) noexcept;

}  // namespace artus
