// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <vector>

#include "artus/detail/devices/kit/body_pose.h"
#include "artus/detail/devices/kit/marker_dictionary.h"

namespace artus::kit {

/// The chess board with markers in its white squares that a camera is calibrated with. Frame as the
/// sheet's; its top left square is black.
inline constexpr int kBoardColumns = 7;
inline constexpr int kBoardRows = 5;
inline constexpr double kBoardSquare = 32e-3;  // m
inline constexpr double kBoardSide = 23e-3;    // m, of its markers

[[nodiscard]] MarkerBody make_board(double scale = 1);

/// An inner corner of the board, where two black squares meet: its place is the same whatever the
/// exposure, which that of an edge is not.
struct BoardCorner {
  int number = 0;  ///< row * (kBoardColumns - 1) + column
  Vec3 p_B = Vec3::Zero();
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
};
/// The corners that are beside markers that were found.
[[nodiscard]] std::vector<BoardCorner> find_board(const cv::Mat& grey, double scale = 1);

}  // namespace artus::kit
