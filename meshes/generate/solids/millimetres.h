// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include "artus/core/geometry.h"

namespace artus {

/// Writes positions of the reference shoulder (24 mm head) in millimetres and gives them in metres
/// at the wanted size.
class Millimetres {
 public:
  explicit Millimetres(double head_radius) : factor_(head_radius / 24) {}
  [[nodiscard]] Vec3 at(double x, double y, double z) const { return factor_ * Vec3(x, y, z); }
  [[nodiscard]] double length(double mm) const { return factor_ * mm; }

 private:
  double factor_;
};

}  // namespace artus
