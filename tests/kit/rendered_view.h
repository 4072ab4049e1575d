// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstdint>
#include <vector>

#include <opencv2/core.hpp>

#include "artus/detail/devices/kit/body.h"
#include "artus/detail/devices/kit/lens.h"

namespace artus::test {

/// What a camera does to light, and what is in its way.
struct ViewFlaws {
  double blur = 0.7;    ///< pixels, standard deviation
  double noise = 0.01;  ///< of the brightest
  double gamma = 2.2;
  double sharpening = 0.3;    ///< share of the unsharp mask
  int jpeg = 80;              ///< quality; 0: none
  double uneven = 0.4;        ///< share by which light falls off over the picture
  double light = 1;           ///< of all
  int clutter = 40;           ///< things in the background
  double hidden = 0.07;       ///< share of markers with a finger on them
  std::uint64_t picture = 0;  ///< which of a scene's pictures: the noise alone differs
};

/// A body as it stands before the camera, with or without the paper around its markers.
struct ShownBody {
  kit::MarkerBody body;
  Pose X_CB;
  double margin = 1.0 / 6;                          ///< white around each marker, of its side
  Eigen::Vector2d paper = Eigen::Vector2d::Zero();  ///< m, half sides of a sheet in z = 0; 0: none
};

/// The checkers of a board in front of the camera, drawn under its markers. Frame as the sheet's.
struct ShownBoard {
  Pose X_CB;
  int columns = 0;
  int rows = 0;
  double square = 0;  ///< m
  double bow = 0;     ///< m by which its middle stands out of its plane
};

/// Draws what a camera sees.
class ViewRenderer {
 public:
  explicit ViewRenderer(const kit::Lens& lens);

  /// A grey picture (8 bit) of the bodies. Depends on `seed` and what is shown alone.
  [[nodiscard]] cv::Mat render(const std::vector<ShownBody>& bodies, const ViewFlaws& flaws,
                               std::uint64_t seed, const ShownBoard* board = nullptr) const;

 private:
  kit::Lens lens_;
  std::vector<Eigen::Vector2d> looks_;  // of each pixel, rows one after the other
};

}  // namespace artus::test
