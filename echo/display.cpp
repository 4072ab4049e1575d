// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/echo/display.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "artus/echo/simd.h"

namespace artus {
namespace {

/// log2 of the positive normal number with these bits: exponent from the bits, mantissa by the
/// series of artanh.
inline float fast_log2(std::uint32_t bits) noexcept {
  const std::uint32_t shifted = bits - 0x3f3504f3U;  // sqrt(1/2): mantissa in [0.7, 1.4)
  const auto exponent = static_cast<float>(static_cast<std::int32_t>(shifted) >> 23);
  const auto mantissa = std::bit_cast<float>((shifted & 0x007fffffU) + 0x3f3504f3U);
  const float t = (mantissa - 1.0F) / (mantissa + 1.0F);
  const float t2 = t * t;
  const float series = t * (1.0F + t2 * (1.0F / 3 + t2 * (1.0F / 5 + t2 * (1.0F / 7))));
  return exponent + 2.885390082F * series;
}

ARTUS_SIMD
void compress_all(const float* envelope, float gain_db, float* decibel, std::size_t n) noexcept {
  constexpr auto kFloor = std::bit_cast<std::int32_t>(1e-10F);
  for (std::size_t i = 0; i < n; ++i) {
    // bits of positive numbers are ordered as they are; a comparison of floats would not vectorise
    const std::int32_t bits = std::max(std::bit_cast<std::int32_t>(envelope[i]), kFloor);
    decibel[i] = 6.020599913F * fast_log2(static_cast<std::uint32_t>(bits)) + gain_db;
  }
}

}  // namespace

std::vector<float> make_time_gain(const Transducer& transducer, const ImageSettings& settings) {
  std::vector<float> gain(static_cast<std::size_t>(settings.n_samples));
  const double db_per_m = 2 * settings.tgc_db_cm_mhz * 100 * transducer.frequency / 1e6;
  for (std::size_t i = 0; i < gain.size(); ++i) {
    const double z = settings.depth * static_cast<double>(i) / settings.n_samples;
    const double db = std::min(settings.tgc_limit_db, db_per_m * z);
    gain[i] = static_cast<float>(std::pow(10.0, db / 20));
  }
  return gain;
}

void compress(std::span<const float> envelope, float gain_db, std::span<float> decibel) noexcept {
  compress_all(envelope.data(), gain_db, decibel.data(), envelope.size());
}

void smooth_line(std::span<const float> decibel, int n_lines, int l, float share,
                 std::span<float> out) noexcept {
  const std::size_t n = out.size();
  const float* here = decibel.data() + static_cast<std::size_t>(l) * n;
  const float* left = l > 0 ? here - n : here;
  const float* right = l + 1 < n_lines ? here + n : here;
  const float keep = 1 - share;
  const float each = share / 9;
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t a = i > 0 ? i - 1 : i;
    const std::size_t b = i + 1 < n ? i + 1 : i;
    const float sum =
        left[a] + left[i] + left[b] + here[a] + here[i] + here[b] + right[a] + right[i] + right[b];
    out[i] = keep * here[i] + each * sum;
  }
}

ScanConverter::ScanConverter(const Transducer& transducer, const ImageSettings& settings)
    : pixel_(settings.pixel),
      n_samples_(settings.n_samples),
      grey_per_db_(static_cast<float>(255 / settings.dynamic_range_db)),
      dynamic_range_(static_cast<float>(settings.dynamic_range_db)),
      single_line_(transducer.n_lines == 1) {
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
  const double sample_depth = settings.depth / settings.n_samples;
  for (int y = 0; y < height_; ++y) {
    for (int x = 0; x < width_; ++x) {
      const Vec3 p = point_of(x, y);
      double place = 0;  // fractional line
      double depth = 0;  // m along it
      if (transducer.radius == 0) {
        depth = p.z() / std::cos(transducer.steering);
        const double x0 = p.x() - p.z() * std::tan(transducer.steering);
        place = (x0 + transducer.width / 2) / transducer.pitch();
      } else {
        const double above = p.z() + transducer.radius;
        depth = std::hypot(p.x(), above) - transducer.radius;
        place = (std::atan2(p.x(), above) * transducer.radius + transducer.width / 2) /
                transducer.pitch();
      }
      const double sample = depth / sample_depth;
      if (place < -0.5 || place > transducer.n_lines - 0.5 || sample < 0 ||
          sample > n_samples_ - 1) {
        continue;
      }
      const int line = std::clamp(static_cast<int>(place), 0, std::max(0, transducer.n_lines - 2));
      const int row = std::min(static_cast<int>(sample), n_samples_ - 2);
      Sample& s = samples_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                           static_cast<std::size_t>(x)];
      s.index = line * n_samples_ + row;
      s.line = static_cast<float>(std::clamp(place - line, 0.0, 1.0));
      if (transducer.n_lines == 1) s.line = 0;
      s.sample = static_cast<float>(sample - row);
    }
  }
}

void ScanConverter::convert(std::span<const float> decibel, int first_row, int last_row,
                            std::span<std::uint8_t> image) const noexcept {
  const auto begin = static_cast<std::size_t>(first_row) * static_cast<std::size_t>(width_);
  const auto end = static_cast<std::size_t>(last_row) * static_cast<std::size_t>(width_);
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

PixelPoint ScanConverter::pixel_of(const Vec3& p_P) const noexcept {
  return {(p_P.x() - left_) / pixel_ - 0.5, (p_P.z() - top_) / pixel_ - 0.5};
}

Vec3 ScanConverter::point_of(int x, int y) const noexcept {
  return {left_ + (x + 0.5) * pixel_, 0, top_ + (y + 0.5) * pixel_};
}

bool ScanConverter::inside(int x, int y) const noexcept {
  return samples_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                  static_cast<std::size_t>(x)]
             .index >= 0;
}

}  // namespace artus
