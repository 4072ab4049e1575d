// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <vector>

namespace artus {

/// A point of a curve on the screen, pixels.
struct CurvePoint {
  float x;
  float y;
};

/// The same curve to the eye with at most four points of each stretch that stays within a column of
/// pixels: where it comes in and goes out, its lowest and its highest. Graphics in software pay for
/// each point. Cost: linear.
[[nodiscard]] std::vector<CurvePoint> thinned(const std::vector<CurvePoint>& curve);

}  // namespace artus
