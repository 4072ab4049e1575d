// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/echo/image_io.h"

#include <cmath>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "artus/detail/core/check.h"

namespace artus {
namespace {

constexpr int kLeft = 36;  // pixels around the image
constexpr int kTop = 18;
constexpr int kRight = 12;
constexpr int kBottom = 14;
cv::Scalar ink() {
  return cv::Scalar::all(190);
}

int to_pixel(double m, double pixel) {
  return static_cast<int>(std::lround(m / pixel));
}

}  // namespace

cv::Mat grey_image(const Frame& frame) {
  // OpenCV has no const view; the matrix is for reading.
  return {frame.height, frame.width, CV_8UC1, const_cast<std::uint8_t*>(frame.image.data())};
}

cv::Mat annotated_image(const Frame& frame, const Transducer& transducer) {
  return annotated_image(grey_image(frame), frame, transducer);
}

cv::Mat annotated_image(const cv::Mat& picture, const Frame& frame, const Transducer& transducer) {
  ARTUS_REQUIRE(picture.rows == frame.height && picture.cols == frame.width,
                "the picture must have the frame's size");
  cv::Mat out(frame.height + kTop + kBottom, frame.width + kLeft + kRight, picture.type(),
              cv::Scalar::all(0));
  picture.copyTo(out(cv::Rect(kLeft, kTop, frame.width, frame.height)));
  const double depth = frame.n_samples * frame.sample_depth;
  // The middle of a curved face lies below the image's top: depth counts from there.
  const int face = std::max(0, frame.height - to_pixel(depth, frame.pixel));
  for (int mm = 0; mm <= static_cast<int>(std::lround(depth * 1e3)); mm += 5) {
    const int y = kTop + std::min(frame.height - 1, face + to_pixel(mm * 1e-3, frame.pixel));
    const bool whole = mm % 10 == 0;
    cv::line(out, {kLeft - (whole ? 9 : 5), y}, {kLeft - 2, y}, ink(), 1);
    if (whole) {
      cv::putText(out, std::to_string(mm / 10), {kLeft - 28, y + 4}, cv::FONT_HERSHEY_SIMPLEX, 0.38,
                  ink(), 1, cv::LINE_AA);
    }
  }
  cv::putText(out, "cm", {2, kTop - 6}, cv::FONT_HERSHEY_SIMPLEX, 0.35, ink(), 1, cv::LINE_AA);
  const int focus = kTop + face + to_pixel(transducer.elevation_focus, frame.pixel);
  if (focus < kTop + frame.height) {
    const int x = kLeft + frame.width + 2;
    cv::line(out, {x, focus}, {x + 7, focus - 4}, ink(), 1, cv::LINE_AA);
    cv::line(out, {x, focus}, {x + 7, focus + 4}, ink(), 1, cv::LINE_AA);
    cv::line(out, {x + 7, focus - 4}, {x + 7, focus + 4}, ink(), 1, cv::LINE_AA);
  }
  cv::circle(out, {kLeft + 5, kTop - 8}, 4, ink(), 1, cv::LINE_AA);
  return out;
}

cv::Mat colour_labels(const LabelImage& labels, const CompiledJoint& joint) {
  const auto palette = region_palette(joint);
  cv::Mat out(labels.height, labels.width, CV_8UC3);
  for (int y = 0; y < labels.height; ++y) {
    auto* pixels = out.ptr<cv::Vec3b>(y);
    for (int x = 0; x < labels.width; ++x) {
      const std::size_t i = static_cast<std::size_t>(y) * static_cast<std::size_t>(labels.width) +
                            static_cast<std::size_t>(x);
      const auto& colour = palette[labels.regions[i]];
      pixels[x] = labels.needle[i] != 0 ? cv::Vec3b(255, 255, 255)
                                        : cv::Vec3b(colour[2], colour[1], colour[0]);
    }
  }
  return out;
}

Result<void> write_image(const cv::Mat& image, const std::filesystem::path& file) {
  const std::string extension = file.extension().string();
  if (extension != ".png" && extension != ".tiff" && extension != ".tif" && extension != ".jpg") {
    return fail(ErrorCode::unsupported, "images are written as .png, .jpg or .tiff", file.string());
  }
  try {
    if (cv::imwrite(file.string(), image)) return {};
  } catch (const cv::Exception& error) {
    return fail(ErrorCode::unreadable, "cannot write the image: " + error.msg, file.string());
  }
  return fail(ErrorCode::unreadable, "cannot write the image", file.string());
}

Result<void> write_envelope(const Frame& frame, const std::filesystem::path& file) {
  const cv::Mat lines(frame.n_lines, frame.n_samples, CV_32FC1,
                      const_cast<float*>(frame.envelope.data()));
  return write_image(lines.t(), file);
}

}  // namespace artus
