// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include <nlohmann/json.hpp>

namespace artus::test {

/// Where a picture shows what a sonographer looks for; pixels.
struct Landmarks {
  double pixel_mm = 0;
  int bone_step = 5;               ///< columns from one row of `bone` to the next
  std::vector<int> bone;           ///< row at which bone begins; -1: none in that column
  cv::Point needle_in, needle_to;  ///< ends of the shaft that is seen
};
[[nodiscard]] nlohmann::json to_json(const Landmarks& marks);
[[nodiscard]] Landmarks landmarks_from(const nlohmann::json& json);

/// How far two pictures of one place differ, each the worst of its kind. Greys: 255 are the dynamic
/// range, 60 dB, so that 4.25 are 1 dB.
struct PictureDifference {
  double block_mean = 0;   ///< greys, mean of a block of 4 x 4 mm
  double block_std = 0;    ///< greys, standard deviation of one
  double bone_line = 0;    ///< greys, brightness of the bone's line over 3 mm of it
  double bone_depth = 0;   ///< mm, where that line lies, over 3 mm of it
  double bone_shadow = 0;  ///< greys, mean of 5 mm below that line, over 3 mm of it
  double needle_line = 0;  ///< greys, brightness of the needle's line over 2 mm of it
  double shift = 0;        ///< mm, of the whole picture
};
/// Requires: pictures of one size.
[[nodiscard]] PictureDifference compare_pictures(const cv::Mat& expected, const cv::Mat& actual,
                                                 const Landmarks& marks);

/// What is beyond its tolerance, {"block_mean_grey": ...} as in the sidecar: "bone line 4.2 greys
/// (at most 1)". Empty: a sonographer sees no difference.
[[nodiscard]] std::vector<std::string> find_visible(const PictureDifference& difference,
                                                    const nlohmann::json& tolerance);
/// All of it in a line.
[[nodiscard]] std::string to_text(const PictureDifference& difference);

}  // namespace artus::test
