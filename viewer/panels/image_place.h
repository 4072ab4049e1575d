// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <algorithm>
#include <cmath>

namespace artus {

/// A point of the B-mode image in millimetres from its upper left corner.
struct ImagePoint {
  double x_mm = 0;
  double y_mm = 0;
};
[[nodiscard]] inline double distance_mm(const ImagePoint& a, const ImagePoint& b) noexcept {
  return std::hypot(a.x_mm - b.x_mm, a.y_mm - b.y_mm);
}

/// Where the B-mode image stands in the window: `x`, `y` are the pixels of its upper left corner
/// (the right one when it is flipped left to right).
struct ImagePlace {
  double x = 0;
  double y = 0;
  double scale = 1;      ///< pixels a millimetre of tissue, both ways
  bool flipped = false;  ///< the image's first column is at `x` and the next to its left
  [[nodiscard]] ImagePoint point_at(double px, double py) const noexcept {
    return {(flipped ? x - px : px - x) / scale, (py - y) / scale};
  }
  [[nodiscard]] double x_of(const ImagePoint& p) const noexcept {
    return x + (flipped ? -scale : scale) * p.x_mm;
  }
  [[nodiscard]] double y_of(const ImagePoint& p) const noexcept { return y + scale * p.y_mm; }
};

/// What is seen of a zoomed picture: 1 / zoom of its width and of its depth, from the shares `u`,
/// `v` of its width and depth on (of its own columns, flipped or not). It never leaves the picture.
struct PictureView {
  static constexpr double kMax = 4;
  double zoom = 1;
  double u = 0;
  double v = 0;
  void move(double du, double dv) noexcept {
    u = std::clamp(u + du, 0.0, 1 - 1 / zoom);
    v = std::clamp(v + dv, 0.0, 1 - 1 / zoom);
  }
  /// The middle of what is seen stays.
  void zoom_by(double factor) noexcept {
    const double before = 1 / zoom;
    zoom = std::clamp(zoom * factor, 1.0, kMax);
    move((before - 1 / zoom) / 2, (before - 1 / zoom) / 2);
  }
};

}  // namespace artus
