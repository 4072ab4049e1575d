// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/reports/recording_page.h"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

#include "artus/detail/core/printed.h"
#include "artus/detail/core/units.h"
#include "artus/echo/image_io.h"

namespace artus {
namespace {

constexpr int kWidth = 1000;   // pixels
constexpr int kHeight = 1414;  // pixels
constexpr int kMargin = 80;    // pixels
cv::Scalar ink_colour() {
  return {40, 40, 40};
}
cv::Scalar curve_colour() {
  return {160, 90, 20};
}
cv::Scalar grid_colour() {
  return {215, 215, 215};
}

void write_at(cv::Mat& page, const std::string& text, const cv::Point& where, double size) {
  cv::putText(page, text, where, cv::FONT_HERSHEY_SIMPLEX, size, ink_colour(), 1, cv::LINE_AA);
}

/// A round step of at most `most` to a span.
double round_step(double span, int most) {
  const double least = std::max(span, 1e-6) / most;
  const double power = std::pow(10, std::floor(std::log10(least)));
  for (const double factor : {1.0, 2.0, 5.0})
    if (factor * power >= least) return factor * power;
  return 10 * power;
}

/// A curve over time in a frame with a grid and numbers.
void draw_curve(cv::Mat& page, const cv::Rect& place, const std::string& title,
                const std::vector<double>& values, double rate) {
  write_at(page, title, {place.x, place.y - 12}, 0.55);
  if (values.empty()) return;
  const double low = std::min(0.0, *std::min_element(values.begin(), values.end()));
  const double high = std::max(low + 1e-3, *std::max_element(values.begin(), values.end()));
  const double seconds = static_cast<double>(values.size()) / rate;
  const auto at = [&](double time, double value) {
    return cv::Point(
        place.x + static_cast<int>(std::lround(time / seconds * place.width)),
        place.y + place.height -
            static_cast<int>(std::lround((value - low) / (high - low) * place.height)));
  };
  const double rung = round_step(high - low, 6);
  for (double v = std::ceil(low / rung) * rung; v <= high; v += rung) {
    cv::line(page, at(0, v), at(seconds, v), grid_colour());
    write_at(page, printed("%g", v), at(0, v) + cv::Point(-52, 5), 0.45);
  }
  const double step = round_step(seconds, 10);
  for (double t = 0; t <= seconds; t += step) {
    cv::line(page, at(t, low), at(t, high), grid_colour());
    write_at(page, printed("%g", t), at(t, low) + cv::Point(-8, 22), 0.45);
  }
  std::vector<cv::Point> line;
  for (std::size_t i = 0; i < values.size(); ++i)
    line.push_back(at(static_cast<double>(i) / rate, values[i]));
  cv::polylines(page, line, false, curve_colour(), 1, cv::LINE_AA);
  cv::rectangle(page, place, ink_colour());
}

void put_picture(cv::Mat& page, const cv::Mat& picture, const cv::Rect& place) {
  const double scale = std::min({1.0, static_cast<double>(place.width) / picture.cols,
                                 static_cast<double>(place.height) / picture.rows});
  cv::Mat shown;
  cv::resize(picture, shown, {}, scale, scale, cv::INTER_AREA);
  cv::cvtColor(shown, page(cv::Rect(place.tl(), shown.size())), cv::COLOR_GRAY2BGR);
}

}  // namespace

void RecordingPage::take(const HapticSnapshot& tick) {
  const Vec3 force(tick.force_J[0], tick.force_J[1], tick.force_J[2]);
  force_.push_back(-force.dot(to_pose(tick.X_JN).linear().col(2)));
  depth_.push_back(tick.feedback.depth / kMillimetre);
  measured_.push_back(tick.input.device.time_ns);
}

void RecordingPage::take(const FrameInput& input, const Frame& frame,
                         const Transducer& transducer) {
  constexpr double kDeeper = 0.2;  // mm, that make another picture worth its copy
  ++images_;
  const auto tick = std::lower_bound(measured_.begin(), measured_.end(), input.sample_time_ns);
  const auto i = static_cast<std::size_t>(tick - measured_.begin());
  const double depth = i < depth_.size() ? depth_[i] : 0;
  if (!picture_.empty() && depth < deepest_ + kDeeper) return;
  deepest_ = depth;
  picture_ = annotated_image(frame, transducer);
}

cv::Mat RecordingPage::draw() const {
  cv::Mat page(kHeight, kWidth, CV_8UC3, cv::Scalar::all(255));
  write_at(page, "artus: a simulated session, not of a patient", {kMargin, 70}, 0.9);
  const double seconds = static_cast<double>(force_.size()) / rate_;
  write_at(page,
           "joint " + joint_ + ", " + printed("%.1f s, ", seconds) + std::to_string(images_) +
               " images; made by artus " + engine_,
           {kMargin, 105}, 0.55);
  const auto most = [](const std::vector<double>& values) {
    return values.empty() ? 0.0 : *std::max_element(values.begin(), values.end());
  };
  write_at(page,
           printed("largest force %.2f N, ", most(force_)) +
               printed("deepest %.1f mm below the skin", most(depth_)),
           {kMargin, 130}, 0.55);
  const int width = kWidth - 2 * kMargin;
  draw_curve(page, {kMargin, 190, width, 250}, "force against insertion, N, over s", force_, rate_);
  draw_curve(page, {kMargin, 520, width, 250}, "depth of the needle's tip, mm, over s", depth_,
             rate_);
  if (picture_.empty()) return page;
  write_at(page, printed("the image with the tip %.1f mm deep", deepest_), {kMargin, 838}, 0.55);
  put_picture(page, picture_, {kMargin, 855, width, kHeight - 855 - kMargin / 2});
  return page;
}

}  // namespace artus
