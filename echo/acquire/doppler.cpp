// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/echo/acquire/doppler.h"

#include <cmath>
#include <cstddef>
#include <limits>

namespace artus {
namespace {

constexpr double kWallFilter = 0.03;  // of the limit: slower echoes count as tissue. assumed

}  // namespace

double wrap_velocity(double toward, double limit) noexcept {
  return toward - 2 * limit * std::round(toward / (2 * limit));
}

void detect_motion(std::span<const float> re, std::span<const float> im,
                   std::span<const float> time_gain, double toward, double limit,
                   const MotionSpan& found) noexcept {
  const double wrapped = wrap_velocity(toward, limit);
  const bool passes = std::abs(wrapped) > kWallFilter * limit;
  const auto shown = static_cast<float>(wrapped);
  for (std::size_t i = 0; i < found.velocity.size(); ++i) {
    const float power = (re[i] * re[i] + im[i] * im[i]) * time_gain[i] * time_gain[i];
    const bool moves = passes && power > kColourThreshold * kColourThreshold;
    found.velocity[i] = moves ? shown : std::numeric_limits<float>::quiet_NaN();
    found.power_db[i] = moves ? 10 * std::log10(power) : 0;
  }
}

bool may_show_motion(double speed, double limit) noexcept {
  return speed > kWallFilter * limit;
}

}  // namespace artus
