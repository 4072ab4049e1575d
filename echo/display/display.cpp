// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/echo/display/display.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "artus/detail/echo/medium/simd.h"

namespace artus {
namespace {

constexpr float kSilence = -200;  // dB, the least that compress() gives

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
void compress_powers(float* power, float gain_db, std::size_t n) noexcept {
  constexpr auto kFloor = std::bit_cast<std::int32_t>(1e-20F);
  for (std::size_t i = 0; i < n; ++i) {
    const std::int32_t bits = std::max(std::bit_cast<std::int32_t>(power[i]), kFloor);
    power[i] = 3.010299957F * fast_log2(static_cast<std::uint32_t>(bits)) + gain_db;
  }
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

void compress(std::span<const float> envelope, float gain_db, std::span<float> decibel) noexcept {
  compress_all(envelope.data(), gain_db, decibel.data(), envelope.size());
}

void compress_power(std::span<float> power, float gain_db) noexcept {
  compress_powers(power.data(), gain_db, power.size());
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

Display::Display(const Transducer& transducer, const ImageSettings& settings)
    : look_(settings.look),
      n_lines_(transducer.n_lines),
      n_samples_(settings.n_samples),
      converter_(transducer, settings),
      reduction_(settings.n_samples, settings.depth / settings.n_samples) {
  if (look_ != Look::raw) clutter_.emplace(transducer, settings);
  set(settings);
}

void Display::set(const LiveSettings& live) {
  live_ = live;
  converter_.set_dynamic_range(live.dynamic_range_db);
  if (look_ != Look::raw) converter_.set_curve(live.grey_curve, live.grain);
  if (live.smoothing > 0 || (look_ != Look::raw && live.speckle_reduction))
    smooth_.resize(static_cast<std::size_t>(n_lines_) * static_cast<std::size_t>(n_samples_));
}

/// Compresses, with the clutter in it.
void Display::level(BlockWorkers& workers, const Pose& X_JP, Frame& frame) {
  const auto n = static_cast<std::size_t>(n_samples_);
  const auto gain = static_cast<float>(live_.gain_db);
  if (!clutter_ || !live_.clutter) {
    workers.for_blocks(n_lines_, [&](int, int first, int last) {
      const std::size_t begin = static_cast<std::size_t>(first) * n;
      const std::size_t size = static_cast<std::size_t>(last - first) * n;
      compress(std::span(frame.envelope).subspan(begin, size), gain,
               std::span(frame.decibel).subspan(begin, size));
    });
    return;
  }
  clutter_->place(X_JP);
  clutter_->gather(workers, frame.envelope);
  workers.for_blocks(n_lines_, [&](int, int first, int last) {
    for (int l = first; l < last; ++l) {
      const std::size_t begin = static_cast<std::size_t>(l) * n;
      const auto power = std::span(frame.decibel).subspan(begin, n);
      clutter_->add(std::span(frame.envelope).subspan(begin, n), l, power);
      compress_power(power, gain);
    }
  });
}

template <class Change>
void Display::replace_lines(BlockWorkers& workers, Frame& frame, const Change& change) {
  const auto n = static_cast<std::size_t>(n_samples_);
  workers.for_blocks(n_lines_, [&](int, int first, int last) {
    for (int l = first; l < last; ++l)
      change(l, std::span(smooth_).subspan(static_cast<std::size_t>(l) * n, n));
  });
  std::swap(smooth_, frame.decibel);
}

void Display::show(BlockWorkers& workers, const Pose& X_JP, Frame& frame) {
  level(workers, X_JP, frame);
  if (look_ != Look::raw && live_.speckle_reduction) {
    replace_lines(workers, frame, [&](int l, std::span<float> out) {
      reduction_.reduce(frame.decibel, n_lines_, l, out);
    });
  }
  if (live_.smoothing > 0) {
    replace_lines(workers, frame, [&](int l, std::span<float> out) {
      smooth_line(frame.decibel, n_lines_, l, static_cast<float>(live_.smoothing), out);
    });
  }
  const bool persists = live_.persistence > 0 && has_previous_;
  if (persists) previous_ = frame.image;
  workers.for_blocks(frame.height, [&](int, int first, int last) {
    converter_.convert(frame.decibel, first, last, frame.image);
  });
  if (persists) keep_previous(frame.image);
  has_previous_ = true;
}

/// Blends the image before into the new one.
void Display::keep_previous(std::vector<std::uint8_t>& image) {
  const auto keep = static_cast<float>(live_.persistence);
  for (std::size_t i = 0; i < previous_.size(); ++i) {
    const auto now = static_cast<float>(image[i]);
    const auto before = static_cast<float>(previous_[i]);
    image[i] = static_cast<std::uint8_t>(std::lround(now + keep * (before - now)));
  }
}

void Display::show_nothing(Frame& frame) noexcept {
  std::fill(frame.decibel.begin(), frame.decibel.end(), kSilence);
  std::fill(frame.image.begin(), frame.image.end(), std::uint8_t{0});
  has_previous_ = false;
}

}  // namespace artus
