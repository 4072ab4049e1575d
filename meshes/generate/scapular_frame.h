// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cmath>

#include "artus/core/geometry.h"

namespace artus {

/// Positions of the shoulder in the plane of the scapula, in which the supraspinatus runs: u
/// medial, v backward across the plane, z up, in millimetres of the reference shoulder (24 mm
/// head), origin at the centre of the head. They are given in frame J, in metres at the wanted
/// size.
class ScapularFrame {
 public:
  explicit ScapularFrame(double head_radius) : factor_(head_radius / 24) {}
  [[nodiscard]] Vec3 at(double u, double v, double z) const { return factor_ * direction(u, v, z); }
  /// A point of the plane `v` at `radius` from the middle of its circle, `degrees` from straight up
  /// to lateral.
  [[nodiscard]] Vec3 on_circle(double radius, double degrees, double v) const {
    const Vec3 out = outward(degrees);
    return factor_ * (radius * out + direction(0, v, 0));
  }
  /// The direction from the middle of that circle to the point. No length.
  [[nodiscard]] static Vec3 outward(double degrees) {
    const double angle = degrees * kRadians;
    return direction(-std::sin(angle), 0, std::cos(angle));
  }
  /// u, v, z as a vector of frame J of the same length.
  [[nodiscard]] static Vec3 direction(double u, double v, double z) {
    return {kMedial * u - kAcross * v, kAcross * u + kMedial * v, z};
  }

  /// The directions u, v and z as columns.
  [[nodiscard]] static Eigen::Matrix3d axes() {
    Eigen::Matrix3d columns;
    columns << direction(1, 0, 0), direction(0, 1, 0), direction(0, 0, 1);
    return columns;
  }

 private:
  static constexpr double kRadians = 0.017453292519943295;
  static constexpr double kMedial = 0.911;    // cosine of the plane's angle to the coronal plane,
  static constexpr double kAcross = 0.41243;  // and its sine: 24.4 degrees
  double factor_;
};

}  // namespace artus
