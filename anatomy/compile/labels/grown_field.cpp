// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/compile/labels/grown_field.h"

#include <algorithm>
#include <cmath>

namespace artus {

DistanceField offset_field(const DistanceField& field, double grow, const FieldSampling& sampling) {
  return DistanceField::compute_throughout(
      [&field, grow](const Vec3& p) { return field.value(p) - grow; }, sampling);
}

DistanceField swept_field(const DistanceField& field, const DistanceField& skin, double grow,
                          double thickness, const FieldSampling& sampling) {
  constexpr double kStep = 0.25;  // of the thickness, between copies
  const double side = grow > 0 ? 1 : -1;
  const int steps = std::max(1, static_cast<int>(std::ceil(std::abs(grow) / (kStep * thickness))));
  return DistanceField::compute_throughout(
      [&field, &skin, grow, side, steps](const Vec3& p) {
        const Vec3 displacement = grow / steps * skin.normal(p);
        double value = side * field.value(p);
        for (int k = 1; k <= steps; ++k)
          value = std::min(value, side * field.value(p - k * displacement));
        return side * value;
      },
      sampling);
}

}  // namespace artus
