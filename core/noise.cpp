// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/core/noise.h"

#include <cmath>

namespace artus {

double normal_noise(std::uint64_t seed, std::uint64_t index) noexcept {
  const double u1 = 1.0 - uniform_noise(seed, 2 * index);  // (0, 1]: the logarithm stays finite
  const double u2 = uniform_noise(seed, 2 * index + 1);
  return std::sqrt(-2 * std::log(u1)) * std::cos(6.283185307179586 * u2);
}

}  // namespace artus
