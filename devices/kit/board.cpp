// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/devices/kit/board.h"

#include <algorithm>
#include <cmath>

#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

namespace artus::kit {

MarkerBody make_board(double scale) {
  MarkerBody board{"board", {}};
  const double side = scale * kBoardSquare;
  int id = kBoardId;
  for (int row = 0; row < kBoardRows; ++row)
    for (int column = 0; column < kBoardColumns; ++column) {
      if ((row + column) % 2 == 0) continue;
      const Vec3 centre((column + 0.5 - kBoardColumns / 2.0) * side,
                        (kBoardRows / 2.0 - row - 0.5) * side, 0);
      board.markers.push_back(
          make_marker(id++, scale * kBoardSide, centre, Vec3::UnitX(), -Vec3::UnitY()));
    }
  return board;
}

std::vector<BoardCorner> find_board(const cv::Mat& grey, double scale) {
  const MarkerBody board = make_board(scale);
  const double side = scale * kBoardSquare;
  const std::vector<FoundMarker> found = find_markers(grey);
  std::vector<BoardCorner> corners;
  std::vector<cv::Point2f> places;
  double window = 8;  // pixels
  for (int row = 1; row < kBoardRows; ++row)
    for (int column = 1; column < kBoardColumns; ++column) {
      const Vec3 p((column - kBoardColumns / 2.0) * side, (kBoardRows / 2.0 - row) * side, 0);
      std::vector<cv::Point2f> on_board;
      std::vector<cv::Point2f> on_picture;
      for (const FoundMarker& one : found)
        for (const Marker& marker : board.markers) {
          if (marker.id != one.id || (marker.centre() - p).norm() > 1.01 * side) continue;
          for (std::size_t i = 0; i < 4; ++i) {
            on_board.emplace_back(static_cast<float>(marker.corners[i].x() / side),
                                  static_cast<float>(marker.corners[i].y() / side));
            on_picture.push_back(one.corners[i]);
          }
        }
      if (on_board.size() < 8) continue;  // both markers beside it
      const cv::Mat to_picture = cv::findHomography(on_board, on_picture);
      if (to_picture.empty()) continue;
      std::vector<cv::Point2f> there;
      cv::perspectiveTransform(std::vector<cv::Point2f>{{static_cast<float>(p.x() / side),
                                                         static_cast<float>(p.y() / side)}},
                               there, to_picture);
      corners.push_back({(row - 1) * (kBoardColumns - 1) + column - 1, p, Eigen::Vector2d::Zero()});
      places.push_back(there.front());
      window = std::min(window, 0.12 * cv::norm(on_picture[0] - on_picture[2]));
    }
  if (corners.empty()) return corners;
  const int half = std::max(2, static_cast<int>(window));
  cv::cornerSubPix(grey, places, {half, half}, {-1, -1},
                   {cv::TermCriteria::EPS | cv::TermCriteria::MAX_ITER, 40, 1e-3});
  for (std::size_t i = 0; i < corners.size(); ++i)
    corners[i].pixel = Eigen::Vector2d(places[i].x, places[i].y);
  return corners;
}

}  // namespace artus::kit
