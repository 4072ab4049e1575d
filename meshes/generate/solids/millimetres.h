// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include "artus/core/geometry.h"

namespace artus {

/// Writes positions of a reference joint in millimetres and gives them in metres at the wanted
/// size: shoulder and hip by their head's radius, 24 mm in the reference.
class Millimetres {
 public:
  explicit Millimetres(double head_radius) : factor_(head_radius / 24) {}
  /// Of a joint whose size is told by a scale, 1 in the reference.
  [[nodiscard]] static Millimetres of_scale(double scale) { return Millimetres(24e-3 * scale); }
  [[nodiscard]] Vec3 at(double x, double y, double z) const { return factor_ * Vec3(x, y, z); }
  [[nodiscard]] double length(double mm) const { return factor_ * mm; }

 private:
  double factor_;
};

}  // namespace artus
