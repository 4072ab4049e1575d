// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/echo/display/scan_converter.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "artus/detail/core/noise.h"

namespace artus {
namespace {

constexpr double kGrain = 6;  // levels of 1024 to either side. assumed: 0.35 dB of a range of 60
constexpr std::uint64_t kGrainSeed = 0x677261696e;

}  // namespace

ScanConverter::ScanConverter(const Transducer& transducer, const ImageSettings& settings)
    : pixel_(settings.pixel),
      n_samples_(settings.n_samples),
      single_line_(transducer.n_lines == 1) {
  set_dynamic_range(settings.dynamic_range_db);
  const Scanline first = scanline(transducer, 0);
  const Scanline last = scanline(transducer, transducer.n_lines - 1);
  const auto end = [&](const Scanline& line) -> Vec3 {
    return line.origin + settings.depth * line.direction;
  };
  left_ = std::min(
      {first.origin.x(), end(first).x(), -transducer.width / 2 * (transducer.radius == 0 ? 1 : 0)});
  const double right =
      std::max({last.origin.x(), end(last).x(), -left_ * (transducer.steering == 0 ? 1 : 0)});
  top_ = std::min({0.0, first.origin.z(), last.origin.z()});
  const double bottom = settings.depth;
  width_ = std::max(1, static_cast<int>(std::lround((right - left_) / pixel_)));
  height_ = std::max(1, static_cast<int>(std::lround((bottom - top_) / pixel_)));
  samples_.resize(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
  for (int y = 0; y < height_; ++y) {
    for (int x = 0; x < width_; ++x) {
      samples_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
               static_cast<std::size_t>(x)] =
          find_sample(transducer, settings.depth / settings.n_samples, point_of(x, y));
    }
  }
}

void ScanConverter::set_dynamic_range(double decibel) noexcept {
  grey_per_db_ = static_cast<float>(255 / decibel);
  dynamic_range_ = static_cast<float>(decibel);
}

void ScanConverter::set_curve(const GreyCurve& curve, bool grain) {
  has_curve_ = true;
  constexpr auto kPieces = static_cast<double>(GreyCurve::kKnots - 1);
  for (int level = 0; level < kLevels; ++level) {
    const double at = kPieces * level / (kLevels - 1);
    const std::size_t k = std::min(static_cast<std::size_t>(at), GreyCurve::kKnots - 2);
    const double share = at - static_cast<double>(k);
    const double grey = curve.grey[k] + share * (curve.grey[k + 1] - curve.grey[k]);
    grey_[static_cast<std::size_t>(level)] = static_cast<std::uint8_t>(std::lround(255 * grey));
  }
  grain_.resize(grain ? samples_.size() : 0);
  for (std::size_t k = 0; k < grain_.size(); ++k)
    grain_[k] =
        static_cast<std::int8_t>(std::lround(kGrain * (2 * uniform_noise(kGrainSeed, k) - 1)));
}

/// Where a point of the image's plane lies among lines and samples.
ScanConverter::Sample ScanConverter::find_sample(const Transducer& transducer, double sample_depth,
                                                 const Vec3& p) const noexcept {
  double place = 0;  // fractional line
  double depth = 0;  // m along it
  if (transducer.radius == 0) {
    depth = p.z() / std::cos(transducer.steering);
    const double x0 = p.x() - p.z() * std::tan(transducer.steering);
    place = (x0 + transducer.width / 2) / transducer.pitch();
  } else {
    const double above = p.z() + transducer.radius;
    depth = std::hypot(p.x(), above) - transducer.radius;
    place =
        (std::atan2(p.x(), above) * transducer.radius + transducer.width / 2) / transducer.pitch();
  }
  Sample s;
  const double sample = depth / sample_depth;
  if (place < -0.5 || place > transducer.n_lines - 0.5 || sample < 0 || sample > n_samples_ - 1)
    return s;
  const int line = std::clamp(static_cast<int>(place), 0, std::max(0, transducer.n_lines - 2));
  const int row = std::min(static_cast<int>(sample), n_samples_ - 2);
  s.index = line * n_samples_ + row;
  s.line = transducer.n_lines == 1 ? 0 : static_cast<float>(std::clamp(place - line, 0.0, 1.0));
  s.sample = static_cast<float>(sample - row);
  return s;
}

void ScanConverter::convert(std::span<const float> decibel, int first_row, int last_row,
                            std::span<std::uint8_t> image) const noexcept {
  const auto begin = static_cast<std::size_t>(first_row) * static_cast<std::size_t>(width_);
  const auto end = static_cast<std::size_t>(last_row) * static_cast<std::size_t>(width_);
  if (has_curve_) return convert_by_curve(decibel, begin, end, image);
  convert_straight(decibel, begin, end, image);
}

void ScanConverter::convert_straight(std::span<const float> decibel,
                                     std::span<std::uint8_t> image) const noexcept {
  convert_straight(decibel, 0, samples_.size(), image);
}

void ScanConverter::convert_straight(std::span<const float> decibel, std::size_t begin,
                                     std::size_t end,
                                     std::span<std::uint8_t> image) const noexcept {
  const std::ptrdiff_t next_line = single_line_ ? 0 : n_samples_;
  const float offset = dynamic_range_ * grey_per_db_ + 0.5F;  // black, and rounding to the nearest
  for (std::size_t k = begin; k < end; ++k) {
    const Sample& s = samples_[k];
    if (s.index < 0) {
      image[k] = 0;
      continue;
    }
    const float* a = decibel.data() + s.index;
    const float* b = a + next_line;
    const float near = a[0] + s.sample * (a[1] - a[0]);
    const float far = b[0] + s.sample * (b[1] - b[0]);
    const float db = near + s.line * (far - near);
    const auto grey = static_cast<int>(db * grey_per_db_ + offset);
    image[k] = static_cast<std::uint8_t>(std::clamp(grey, 0, 255));
  }
}

void ScanConverter::convert_by_curve(std::span<const float> decibel, std::size_t begin,
                                     std::size_t end,
                                     std::span<std::uint8_t> image) const noexcept {
  const std::ptrdiff_t next_line = single_line_ ? 0 : n_samples_;
  const float level_per_db = static_cast<float>(kLevels - 1) / dynamic_range_;
  for (std::size_t k = begin; k < end; ++k) {
    const Sample& s = samples_[k];
    if (s.index < 0) {
      image[k] = 0;
      continue;
    }
    const float* a = decibel.data() + s.index;
    const float* b = a + next_line;
    const float near = a[0] + s.sample * (a[1] - a[0]);
    const float far = b[0] + s.sample * (b[1] - b[0]);
    const float above = near + s.line * (far - near) + dynamic_range_;
    const int grain = grain_.empty() ? 0 : grain_[k];
    const int level = static_cast<int>(above * level_per_db + 0.5F) + grain;
    image[k] = grey_[static_cast<std::size_t>(std::clamp(level, 0, kLevels - 1))];
  }
}

PixelPoint ScanConverter::pixel_of(const Vec3& p_P) const noexcept {
  return {(p_P.x() - left_) / pixel_ - 0.5, (p_P.z() - top_) / pixel_ - 0.5};
}

Vec3 ScanConverter::point_of(int x, int y) const noexcept {
  return {left_ + (x + 0.5) * pixel_, 0, top_ + (y + 0.5) * pixel_};
}

ScanConverter::LinePlace ScanConverter::line_at(int x, int y) const noexcept {
  const Sample& s = samples_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                             static_cast<std::size_t>(x)];
  return {s.index / n_samples_, static_cast<double>(s.line),
          s.index % n_samples_ + static_cast<double>(s.sample)};
}

bool ScanConverter::inside(int x, int y) const noexcept {
  return samples_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                  static_cast<std::size_t>(x)]
             .index >= 0;
}

bool ScanConverter::inside(const PixelPoint& place) const noexcept {
  const double x = std::round(place.x);
  const double y = std::round(place.y);
  return x >= 0 && x < width_ && y >= 0 && y < height_ &&
         inside(static_cast<int>(x), static_cast<int>(y));
}

}  // namespace artus
