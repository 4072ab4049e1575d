// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <span>

namespace artus {

/// A Butterworth low-pass of second order by the bilinear transform, its corner kept in place:
/// y = b0 x + b1 x' + b2 x'' - a1 y' - a2 y''.
struct LowPass {
  double b0 = 1;
  double b1 = 0;
  double b2 = 0;
  double a1 = 0;
  double a2 = 0;
};

/// Requires: 0 < corner < rate / 2, both Hz.
[[nodiscard]] LowPass make_butterworth(double corner, double rate);

/// Filters forward and backward in place: no delay, gain squared (half at the corner). Both ends
/// are continued by half a second of their own reflection through the end point, so that a straight
/// run stays straight to its ends. `rate`: Hz. Cost: linear; allocates a copy.
void filter_zero_phase(const LowPass& filter, double rate, std::span<double> values);

}  // namespace artus
