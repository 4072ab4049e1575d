// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <vector>

#include <opencv2/core.hpp>

namespace artus::kit {

/// Cells of a marker: 6 x 6 with its black border, row by row from the top left; true is white.
using MarkerCells = std::array<std::array<bool, 6>, 6>;
/// Of the dictionary 4x4_50. Requires: 0 to 49.
[[nodiscard]] MarkerCells cells_of_marker(int id);

/// A marker as it was found: corners in pixels (centres of pixels are whole numbers), top left of
/// its print first, then clockwise. Some tenths of a pixel off.
struct FoundMarker {
  int id = 0;
  std::array<cv::Point2f, 4> corners;
};

/// All markers of a grey picture (8 bit); one whose number is there twice is left out, as nobody
/// can say which it is. The only place that calls OpenCV's ArUco module, whose classes differ
/// between 4.6 and later ones. Cost: 4 to 12 ms of 1280 x 720.
[[nodiscard]] std::vector<FoundMarker> find_markers(const cv::Mat& grey);

}  // namespace artus::kit
