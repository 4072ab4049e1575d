// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/echo/display/motion_picture.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "artus/detail/core/check.h"

namespace artus {
namespace {

constexpr double kFaintest = -70;   // dB of power. assumed
constexpr double kStrongest = -30;  // dB. assumed

}  // namespace

std::vector<std::uint8_t> motion_picture(const Frame& frame, const ScanConverter& converter,
                                         const ImageSettings& settings, MotionShown shown) {
  ARTUS_REQUIRE(frame.velocity.size() == frame.decibel.size(), "the frame has no velocities");
  // Velocities go through the converter of every other image as greys: -limit is black, limit
  // white, and what stands still is below black.
  constexpr float kStill = -1e6F;  // dB
  std::vector<float> levels(frame.velocity.size());
  for (std::size_t i = 0; i < levels.size(); ++i) {
    const double v = shown == MotionShown::power
                         ? 2 * (frame.motion_db[i] - kFaintest) / (kStrongest - kFaintest) - 1
                         : static_cast<double>(frame.velocity[i]) / settings.doppler_limit;
    levels[i] =
        std::isnan(frame.velocity[i])
            ? kStill
            : static_cast<float>((std::clamp(v, -1.0, 1.0) - 1) / 2 * settings.dynamic_range_db);
  }
  std::vector<std::uint8_t> picture(static_cast<std::size_t>(frame.width) *
                                    static_cast<std::size_t>(frame.height));
  converter.convert_straight(levels, picture);
  return picture;
}

std::array<std::uint8_t, 3> motion_colour(std::uint8_t level, MotionShown shown) noexcept {
  if (shown == MotionShown::power) {
    const double strength = level / 255.0;
    return {static_cast<std::uint8_t>(110 + 145 * strength),
            static_cast<std::uint8_t>(200 * strength * strength), 0};
  }
  const double v = 2 * level / 255.0 - 1;  // of the limit, toward the probe
  const auto strong = static_cast<std::uint8_t>(110 + 145 * std::abs(v));
  const auto weak = static_cast<std::uint8_t>(140 * std::abs(v));
  if (v > 0) return {strong, weak, 0};
  return {0, weak, strong};
}

}  // namespace artus
