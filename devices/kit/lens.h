// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>

#include <opencv2/core.hpp>

#include <Eigen/Core>

#include "artus/core/geometry.h"

namespace artus::kit {

/// How a camera pictures what is before it: OpenCV's pinhole with radial and tangential distortion.
/// Centres of pixels are whole numbers.
struct Lens {
  int width = 1280;                    ///< pixels
  int height = 720;                    ///< pixels
  double fx = 1000;                    ///< pixels
  double fy = 1000;                    ///< pixels
  double cx = 639.5;                   ///< pixels
  double cy = 359.5;                   ///< pixels
  std::array<double, 5> distortion{};  ///< k1 k2 p1 p2 k3
  double focal_error = 0;              ///< share of the focal length, 95 %

  [[nodiscard]] cv::Matx33d matrix() const;
  /// Where in the plane z = 1 of the camera's frame a pixel looks.
  [[nodiscard]] Eigen::Vector2d looks_at(const Eigen::Vector2d& pixel) const;
  /// The pixel of a point in frame C. Requires: it is in front of the camera.
  [[nodiscard]] Eigen::Vector2d project(const Vec3& p_C) const;
};

}  // namespace artus::kit
