// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/evidence/validation/echo/screen_measures.h"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

#include "artus/detail/echo/display/frame_measure.h"

namespace artus {
namespace {

constexpr int kSlopeReach = 5;         // columns to either side
constexpr double kWindow = 1.5e-3;     // m to either side of the surface
constexpr double kAboveTissue = 3e-3;  // m of tissue that the line must outshine
constexpr double kStandsOut = 1.5;     // times as bright
constexpr double kWhite = 200;         // grey that is a line whatever lies above
constexpr double kEvennessReach = 20;  // columns over which brightness may drift

/// One column's line.
struct Column {
  double peak = 0;
  double thickness = 0;  // px along the column
  bool stands_out = false;
};

Column look_at(const cv::Mat& image, int x, int row, double pixel) {
  const auto grey = [&](int y) {
    return static_cast<double>(image.at<std::uint8_t>(y, x));
  };
  const int window = static_cast<int>(kWindow / pixel);
  const int first = std::max(0, row - window);
  const int last = std::min(image.rows - 1, row + window);
  Column column;
  int at = first;
  for (int y = first; y <= last; ++y)
    if (grey(y) > grey(at)) at = y;
  column.peak = grey(at);
  std::vector<double> above;
  for (int y = std::max(0, first - static_cast<int>(kAboveTissue / pixel)); y < first; ++y)
    above.push_back(grey(y));
  std::sort(above.begin(), above.end());
  column.stands_out =
      column.peak >= kWhite || column.peak > kStandsOut * sorted_percentile(above, 0.5);
  int upper = at;
  int lower = at;
  while (upper > 0 && grey(upper - 1) > column.peak / 2) --upper;
  while (lower + 1 < image.rows && grey(lower + 1) > column.peak / 2) ++lower;
  column.thickness = lower - upper + 1;
  return column;
}

double median_of(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return sorted_percentile(values, 0.5);
}

/// Deviation over mean of values once a moving mean is taken out.
double unevenness(const std::vector<double>& values) {
  double squares = 0;
  const auto n = static_cast<std::ptrdiff_t>(values.size());
  const auto reach = static_cast<std::ptrdiff_t>(kEvennessReach);
  double mean = 0;
  for (const double v : values) mean += v / static_cast<double>(n);
  for (std::ptrdiff_t i = 0; i < n; ++i) {
    double local = 0;
    const auto from = std::max<std::ptrdiff_t>(0, i - reach);
    const auto to = std::min(n - 1, i + reach);
    for (auto k = from; k <= to; ++k)
      local += values[static_cast<std::size_t>(k)] / static_cast<double>(to - from + 1);
    const double off = values[static_cast<std::size_t>(i)] - local;
    squares += off * off / static_cast<double>(n);
  }
  return mean > 0 ? std::sqrt(squares) / mean : 0;
}

}  // namespace

BoneLine measure_bone_line(const cv::Mat& image, const std::vector<double>& surface, double pixel,
                           double from, double to) {
  BoneLine line;
  std::vector<double> peaks;
  std::vector<double> thickness;
  for (int x = kSlopeReach; x + kSlopeReach < image.cols; ++x) {
    const double before = surface[static_cast<std::size_t>(x - kSlopeReach)];
    const double here = surface[static_cast<std::size_t>(x)];
    const double after = surface[static_cast<std::size_t>(x + kSlopeReach)];
    if (before < 0 || here < 0 || after < 0) continue;
    const double slope = std::atan(std::abs(after - before) / (2.0 * kSlopeReach));
    if (slope < from || slope >= to) continue;
    const Column column = look_at(image, x, static_cast<int>(std::lround(here)), pixel);
    ++line.columns;
    line.found += column.stands_out ? 1 : 0;
    peaks.push_back(column.peak);
    thickness.push_back(column.thickness * pixel * std::cos(slope));
  }
  if (line.columns == 0) return line;
  line.found /= line.columns;
  line.thickness = median_of(thickness);
  line.mean = moments_of(peaks).mean;
  line.evenness = unevenness(peaks);
  return line;
}

std::vector<double> sorted_grey(const cv::Mat& image, const cv::Mat& mask) {
  std::vector<double> values;
  for (int y = 0; y < image.rows; ++y)
    for (int x = 0; x < image.cols; ++x)
      if (mask.at<std::uint8_t>(y, x) != 0) values.push_back(image.at<std::uint8_t>(y, x));
  std::sort(values.begin(), values.end());
  return values;
}

double sorted_percentile(const std::vector<double>& sorted, double share) {
  if (sorted.empty()) return 0;
  return sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1))];
}

double fine_skewness(const cv::Mat& patch) {
  cv::Mat values;
  patch.convertTo(values, CV_64F);
  cv::Mat coarse;
  cv::GaussianBlur(values, coarse, {}, 1.0, 1.0, cv::BORDER_REFLECT);
  const cv::Mat fine = values - coarse;
  cv::Scalar mean;
  cv::Scalar deviation;
  cv::meanStdDev(fine, mean, deviation);
  double cubes = 0;
  for (int y = 0; y < fine.rows; ++y)
    for (int x = 0; x < fine.cols; ++x) cubes += std::pow(fine.at<double>(y, x) - mean[0], 3);
  return deviation[0] > 0 ? cubes / static_cast<double>(fine.total()) / std::pow(deviation[0], 3)
                          : 0;
}

}  // namespace artus
