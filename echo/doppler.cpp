// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/echo/doppler.h"

#include <cmath>
#include <cstddef>
#include <limits>

#include "artus/core/check.h"

namespace artus {
namespace {

constexpr double kWallFilter = 0.03;   // of the limit: slower echoes count as tissue. assumed
constexpr float kThreshold = 5.6e-3F;  // -45 dB: echoes above show in colour. assumed

}  // namespace

double wrap_velocity(double toward, double limit) noexcept {
  return toward - 2 * limit * std::round(toward / (2 * limit));
}

void detect_motion(std::span<const float> re, std::span<const float> im,
                   std::span<const float> time_gain, double toward, double limit,
                   std::span<float> velocity) noexcept {
  const double wrapped = wrap_velocity(toward, limit);
  const bool passes = std::abs(wrapped) > kWallFilter * limit;
  const auto shown = static_cast<float>(wrapped);
  for (std::size_t i = 0; i < velocity.size(); ++i) {
    const float power = (re[i] * re[i] + im[i] * im[i]) * time_gain[i] * time_gain[i];
    velocity[i] =
        passes && power > kThreshold * kThreshold ? shown : std::numeric_limits<float>::quiet_NaN();
  }
}

bool may_show_motion(double speed, double limit) noexcept {
  return speed > kWallFilter * limit;
}

std::vector<std::uint8_t> motion_picture(const Frame& frame, const ScanConverter& converter,
                                         const ImageSettings& settings) {
  ARTUS_REQUIRE(frame.velocity.size() == frame.decibel.size(), "the frame has no velocities");
  // Velocities go through the converter of every other image as greys: -limit is black, limit
  // white, and what stands still is below black.
  constexpr float kStill = -1e6F;  // dB
  std::vector<float> levels(frame.velocity.size());
  for (std::size_t i = 0; i < levels.size(); ++i) {
    const double v = static_cast<double>(frame.velocity[i]) / settings.doppler_limit;
    levels[i] =
        std::isnan(v) ? kStill : static_cast<float>((v - 1) / 2 * settings.dynamic_range_db);
  }
  std::vector<std::uint8_t> picture(static_cast<std::size_t>(frame.width) *
                                    static_cast<std::size_t>(frame.height));
  converter.convert(levels, 0, frame.height, picture);
  return picture;
}

std::array<std::uint8_t, 3> motion_colour(std::uint8_t level) noexcept {
  const double v = 2 * level / 255.0 - 1;  // of the limit, toward the probe
  const auto strong = static_cast<std::uint8_t>(110 + 145 * std::abs(v));
  const auto weak = static_cast<std::uint8_t>(140 * std::abs(v));
  if (v > 0) return {strong, weak, 0};
  return {0, weak, strong};
}

}  // namespace artus
