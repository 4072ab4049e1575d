// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstddef>
#include <span>

namespace artus {

/// Adds an echo that lies between samples: four weights (Catmull and Rom's spline) that keep its
/// height within 0.1 dB once the pulse has been applied, two at a line's ends. Nothing when it lies
/// off the line.
inline void add_point_echo(double sample, double amplitude, std::span<float> line) noexcept {
  if (!(sample >= 0) || sample >= static_cast<double>(line.size()) - 1) return;
  const auto i = static_cast<std::size_t>(sample);
  const auto t = static_cast<float>(sample - static_cast<double>(i));
  const auto a = static_cast<float>(amplitude);
  if (i == 0 || i + 2 >= line.size()) {
    line[i] += (1 - t) * a;
    line[i + 1] += t * a;
    return;
  }
  const float t2 = t * t;
  const float t3 = t2 * t;
  line[i - 1] += 0.5F * (2 * t2 - t3 - t) * a;
  line[i] += 0.5F * (3 * t3 - 5 * t2 + 2) * a;
  line[i + 1] += 0.5F * (4 * t2 - 3 * t3 + t) * a;
  line[i + 2] += 0.5F * (t3 - t2) * a;
}

}  // namespace artus
