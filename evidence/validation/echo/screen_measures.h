// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <vector>

#include <opencv2/core.hpp>

/// What one reads off a picture on a screen, in grey: the same for a real one and for ours.
namespace artus {

/// Bone's line in the columns of a picture whose slope lies in a band.
struct BoneLine {
  int columns = 0;       ///< looked at
  double found = 0;      ///< share of them in which it stands out
  double thickness = 0;  ///< m, median, at half height, across the line
  double mean = 0;       ///< grey of its brightest pixel
  double evenness = 0;   ///< standard deviation over mean along it, slow drift taken out
};

/// `surface`: row of bone's surface in each column, negative where there is none; `pixel` m.
/// Columns whose surface rises by `from` to `to` rad. A column's line stands out when its brightest
/// pixel within 1.5 mm is 1.5 times as bright as the median of the 3 mm above it, or above 200.
[[nodiscard]] BoneLine measure_bone_line(const cv::Mat& image, const std::vector<double>& surface,
                                         double pixel, double from, double to);

/// The pixels of a mask, as a sorted row of grey values.
[[nodiscard]] std::vector<double> sorted_grey(const cv::Mat& image, const cv::Mat& mask);

/// A percentile (0..1) of sorted values; 0 of none.
[[nodiscard]] double sorted_percentile(const std::vector<double>& sorted, double share);

/// Skewness of what is finer than a Gaussian of one pixel in a patch.
[[nodiscard]] double fine_skewness(const cv::Mat& patch);

}  // namespace artus
