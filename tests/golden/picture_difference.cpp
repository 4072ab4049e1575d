// SPDX-License-Identifier: AGPL-3.0-or-later
#include "tests/golden/picture_difference.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>

#include <opencv2/imgproc.hpp>

namespace artus::test {
namespace {

constexpr double kBlock = 4;         // mm
constexpr double kBoneWindow = 3;    // mm
constexpr double kNeedleWindow = 2;  // mm
constexpr int kLineBand = 8;         // px about a landmark in which its line is looked for
constexpr double kSeen = 40;         // greys from which a line's place is a place
constexpr double kShadowFrom = 1;    // mm below the bone's line
constexpr double kShadowTo = 6;      // mm

/// Brightest pixel of a column about a row: its grey and its row.
struct LinePoint {
  double grey = 0;
  double row = 0;
};

LinePoint brightest(const cv::Mat& image, int column, int row, int band) {
  LinePoint best{-1, 0};
  for (int y = std::max(0, row - band); y <= std::min(image.rows - 1, row + band); ++y)
    if (image.at<std::uint8_t>(y, column) > best.grey)
      best = {static_cast<double>(image.at<std::uint8_t>(y, column)), static_cast<double>(y)};
  return best;
}

void widen(double& worst, double difference) {
  worst = std::max(worst, std::abs(difference));
}

void compare_blocks(const cv::Mat& a, const cv::Mat& b, int size, PictureDifference& out) {
  for (int y = 0; y + size <= a.rows; y += size)
    for (int x = 0; x + size <= a.cols; x += size) {
      const cv::Rect block(x, y, size, size);
      std::array<cv::Scalar, 2> mean;
      std::array<cv::Scalar, 2> deviation;
      cv::meanStdDev(a(block), mean[0], deviation[0]);
      cv::meanStdDev(b(block), mean[1], deviation[1]);
      widen(out.block_mean, mean[1][0] - mean[0][0]);
      widen(out.block_std, deviation[1][0] - deviation[0][0]);
    }
}

/// The row of a mark for each column; -1 where there is none.
std::vector<int> bone_rows(const Landmarks& marks, int columns) {
  std::vector<int> rows(static_cast<std::size_t>(columns), -1);
  for (int x = 0; x < columns; ++x) {
    const auto i = static_cast<std::size_t>(x / marks.bone_step);
    if (i + 1 >= marks.bone.size() || marks.bone[i] < 0 || marks.bone[i + 1] < 0) continue;
    const double along = static_cast<double>(x % marks.bone_step) / marks.bone_step;
    rows[static_cast<std::size_t>(x)] =
        static_cast<int>(std::lround((1 - along) * marks.bone[i] + along * marks.bone[i + 1]));
  }
  return rows;
}

/// Mean of `value` over each window of columns whose rows are all known.
void for_windows(const std::vector<int>& rows, int width,
                 const std::function<void(int first)>& take) {
  for (int first = 0; first + width <= static_cast<int>(rows.size()); first += width / 2) {
    const auto begin = rows.begin() + first;
    if (std::all_of(begin, begin + width, [](int row) { return row >= 0; })) take(first);
  }
}

LinePoint mean_line(const cv::Mat& image, const std::vector<int>& rows, int first, int width) {
  LinePoint mean;
  for (int x = first; x < first + width; ++x) {
    const LinePoint point = brightest(image, x, rows[static_cast<std::size_t>(x)], kLineBand);
    mean.grey += point.grey / width;
    mean.row += point.row / width;
  }
  return mean;
}

double mean_below(const cv::Mat& image, const std::vector<int>& rows, int first, int width,
                  double pixel_mm) {
  double sum = 0;
  int n = 0;
  for (int x = first; x < first + width; ++x) {
    const int line = rows[static_cast<std::size_t>(x)];
    const int from = line + static_cast<int>(kShadowFrom / pixel_mm);
    const int to = std::min(image.rows, line + static_cast<int>(kShadowTo / pixel_mm));
    for (int y = from; y < to; ++y, ++n) sum += image.at<std::uint8_t>(y, x);
  }
  return n > 0 ? sum / n : 0;
}

void compare_bone(const cv::Mat& a, const cv::Mat& b, const Landmarks& marks,
                  PictureDifference& out) {
  const std::vector<int> rows = bone_rows(marks, a.cols);
  const int width = static_cast<int>(std::lround(kBoneWindow / marks.pixel_mm));
  for_windows(rows, width, [&](int first) {
    const LinePoint was = mean_line(a, rows, first, width);
    const LinePoint is = mean_line(b, rows, first, width);
    widen(out.bone_line, is.grey - was.grey);
    if (was.grey >= kSeen) widen(out.bone_depth, (is.row - was.row) * marks.pixel_mm);
    widen(out.bone_shadow, mean_below(b, rows, first, width, marks.pixel_mm) -
                               mean_below(a, rows, first, width, marks.pixel_mm));
  });
}

void compare_needle(const cv::Mat& a, const cv::Mat& b, const Landmarks& marks,
                    PictureDifference& out) {
  constexpr int kNear = 4;  // px
  std::vector<int> rows(static_cast<std::size_t>(a.cols), -1);
  const auto [from, to] = std::minmax(marks.needle_in.x, marks.needle_to.x);
  for (int x = from; x <= to; ++x) {
    const double along = static_cast<double>(x - marks.needle_in.x) /
                         std::max(1, std::abs(marks.needle_to.x - marks.needle_in.x));
    rows[static_cast<std::size_t>(x)] = static_cast<int>(
        std::lround(marks.needle_in.y + std::abs(along) * (marks.needle_to.y - marks.needle_in.y)));
  }
  const int width = static_cast<int>(std::lround(kNeedleWindow / marks.pixel_mm));
  for_windows(rows, width, [&](int first) {
    double change = 0;
    for (int x = first; x < first + width; ++x) {
      const int row = rows[static_cast<std::size_t>(x)];
      change += (brightest(b, x, row, kNear).grey - brightest(a, x, row, kNear).grey) / width;
    }
    widen(out.needle_line, change);
  });
}

double shift_mm(const cv::Mat& a, const cv::Mat& b, double pixel_mm) {
  cv::Mat expected;
  cv::Mat actual;
  a.convertTo(expected, CV_64F);
  b.convertTo(actual, CV_64F);
  cv::Mat window;
  cv::createHanningWindow(window, a.size(), CV_64F);
  return cv::norm(cv::phaseCorrelate(expected, actual, window)) * pixel_mm;
}

struct Measure {
  const char* name;
  const char* key;  // in the sidecar
  const char* unit;
  double PictureDifference::*value;
};
constexpr std::array<Measure, 7> kMeasures{
    {{"mean of a block", "block_mean_grey", "greys", &PictureDifference::block_mean},
     {"spread of a block", "block_std_grey", "greys", &PictureDifference::block_std},
     {"bone line", "bone_line_grey", "greys", &PictureDifference::bone_line},
     {"depth of bone", "bone_depth_mm", "mm", &PictureDifference::bone_depth},
     {"shadow of bone", "bone_shadow_grey", "greys", &PictureDifference::bone_shadow},
     {"needle line", "needle_line_grey", "greys", &PictureDifference::needle_line},
     {"shift", "shift_mm", "mm", &PictureDifference::shift}}};

std::string number(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.3g", value);
  return text.data();
}

}  // namespace

nlohmann::json to_json(const Landmarks& marks) {
  return {
      {"pixel_mm", marks.pixel_mm},
      {"needle_px", {marks.needle_in.x, marks.needle_in.y, marks.needle_to.x, marks.needle_to.y}},
      {"bone_step_px", marks.bone_step},
      {"bone_rows_px", marks.bone}};
}

Landmarks landmarks_from(const nlohmann::json& json) {
  Landmarks marks;
  marks.pixel_mm = json.at("pixel_mm");
  marks.bone_step = json.at("bone_step_px");
  marks.bone = json.at("bone_rows_px").get<std::vector<int>>();
  const auto needle = json.at("needle_px").get<std::array<int, 4>>();
  marks.needle_in = {needle[0], needle[1]};
  marks.needle_to = {needle[2], needle[3]};
  return marks;
}

PictureDifference compare_pictures(const cv::Mat& expected, const cv::Mat& actual,
                                   const Landmarks& marks) {
  PictureDifference out;
  compare_blocks(expected, actual, static_cast<int>(std::lround(kBlock / marks.pixel_mm)), out);
  compare_bone(expected, actual, marks, out);
  compare_needle(expected, actual, marks, out);
  out.shift = shift_mm(expected, actual, marks.pixel_mm);
  return out;
}

std::vector<std::string> find_visible(const PictureDifference& difference,
                                      const nlohmann::json& tolerance) {
  std::vector<std::string> visible;
  for (const Measure& m : kMeasures) {
    const double bound = tolerance.at(m.key);
    if (!(difference.*m.value <= bound))
      visible.push_back(std::string(m.name) + " " + number(difference.*m.value) + " " + m.unit +
                        " (at most " + number(bound) + ")");
  }
  return visible;
}

std::string to_text(const PictureDifference& difference) {
  std::string text;
  for (const Measure& m : kMeasures)
    text += (text.empty() ? "" : ", ") + std::string(m.name) + " " + number(difference.*m.value) +
            " " + m.unit;
  return text;
}

}  // namespace artus::test
