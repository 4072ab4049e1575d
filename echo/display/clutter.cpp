// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/echo/display/clutter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "artus/detail/core/noise.h"
#include "artus/detail/echo/medium/simd.h"
#include "artus/detail/echo/probe/gaussian.h"

namespace artus {
namespace {

// assumed, all of them: set so that lumens and shadows are as grey as in published pictures
constexpr double kCellAcross = 0.3e-3;  // m
constexpr double kCellAlong = 0.16e-3;  // m
constexpr double kLobes = -26;          // dB of all side lobes over the echo
constexpr double kLobeReach = 12;       // widths of the beam over which they fall by a neper
constexpr double kHaze = -39;           // dB of all reverberation over the echo
constexpr double kHazeReach = 7e-3;     // m along depth over which it falls by a neper
constexpr double kHazeBlur = 2e-3;      // m across
constexpr double kHiss = -73;           // dB of the receiver's noise at the face
constexpr double kHissRise = 250;       // dB per m of depth
constexpr double kHissMost = -50;       // dB
constexpr float kMost = 0.06F;          // power of an echo at which the receiver clips
constexpr double kSlice = 1.2e-3;       // m across the plane after which the speckle is another
constexpr double kPatternUnit = 28;     // of the pattern's whole numbers, its rms part
constexpr std::uint64_t kPatternSeed = 0x6c757474;

double power_of(double decibel) {
  return std::pow(10.0, decibel / 10);
}

float keep_of(double step, double reach) {
  return static_cast<float>(std::exp(-step / reach));
}

/// A Gaussian's weights to `reach` steps on either side, of unit power for white noise.
std::vector<float> unit_kernel(double sigma) {
  const int reach = std::max(1, static_cast<int>(std::ceil(3 * sigma)));
  std::vector<float> kernel;
  double power = 0;
  for (int k = -reach; k <= reach; ++k) {
    kernel.push_back(static_cast<float>(std::exp(-0.5 * k * k / (sigma * sigma))));
    power += static_cast<double>(kernel.back() * kernel.back());
  }
  for (float& w : kernel) w /= static_cast<float>(std::sqrt(power));
  return kernel;
}

/// White noise of (n_lines, n_samples), smoothed across and along so that both wrap round.
std::vector<float> smooth_noise(std::uint64_t seed, std::size_t n_lines, std::size_t n_samples,
                                const std::vector<float>& across, const std::vector<float>& along) {
  std::vector<float> white(n_lines * n_samples);
  for (std::size_t i = 0; i < white.size(); ++i)  // unit power; normal, near enough, once smoothed
    white[i] = static_cast<float>(
        (uniform_noise(seed, 2 * i) + uniform_noise(seed, 2 * i + 1) - 1) * std::sqrt(6.0));
  std::vector<float> wide(n_samples + along.size());
  std::vector<float> out(white.size(), 0.0F);
  for (std::size_t l = 0; l < n_lines; ++l) {
    std::fill(wide.begin(), wide.end(), 0.0F);
    for (std::size_t k = 0; k < across.size(); ++k) {
      const float* from = white.data() + (l + k) % n_lines * n_samples;
      for (std::size_t i = 0; i < n_samples; ++i) wide[i] += across[k] * from[i];
    }
    for (std::size_t i = 0; i < along.size(); ++i) wide[n_samples + i] = wide[i % n_samples];
    for (std::size_t k = 0; k < along.size(); ++k)
      for (std::size_t i = 0; i < n_samples; ++i) out[l * n_samples + i] += along[k] * wide[i + k];
  }
  return out;
}

/// out = squared envelope + clutter times the speckle of two blended patterns.
struct PatternRow {
  const std::int8_t* re;
  const std::int8_t* im;
  float weight;
};
ARTUS_SIMD
void add_speckled(const float* envelope, const PatternRow& a, const PatternRow& b, float* power,
                  std::size_t n) noexcept {
  for (std::size_t i = 0; i < n; ++i) {
    const float re =
        a.weight * static_cast<float>(a.re[i]) + b.weight * static_cast<float>(b.re[i]);
    const float im =
        a.weight * static_cast<float>(a.im[i]) + b.weight * static_cast<float>(b.im[i]);
    power[i] = envelope[i] * envelope[i] + power[i] * (re * re + im * im);
  }
}

}  // namespace

/// The two cell rows between which a line lies.
struct Clutter::Rows {
  int first;
  int second;
  float share;  // of the second
};

Clutter::Clutter(const Transducer& transducer, const ImageSettings& settings)
    : n_lines_(transducer.n_lines),
      n_samples_(static_cast<std::size_t>(settings.n_samples)),
      pitch_(transducer.pitch()),
      sample_depth_(settings.depth / settings.n_samples),
      seed_(mix_bits(settings.seed ^ kPatternSeed)) {
  cell_lines_ = std::max(1, static_cast<int>(std::lround(kCellAcross / pitch_)));
  cell_samples_ = static_cast<std::size_t>(std::max(1L, std::lround(kCellAlong / sample_depth_)));
  n_rows_ = (n_lines_ + cell_lines_ - 1) / cell_lines_;
  n_columns_ = (n_samples_ + cell_samples_ - 1) / cell_samples_;
  stride_ = n_columns_ + 1;
  const double width = kTwoWayWidth * transducer.wavelength() * transducer.f_number;
  lobe_keep_ = keep_of(cell_lines_ * pitch_, kLobeReach * width);
  haze_keep_ = keep_of(static_cast<double>(cell_samples_) * sample_depth_, kHazeReach);
  blur_keep_ = keep_of(cell_lines_ * pitch_, kHazeBlur);
  for (std::size_t j = 0; j < stride_; ++j) {
    const double z =
        (static_cast<double>(j) + 0.5) * static_cast<double>(cell_samples_) * sample_depth_;
    floor_.push_back(static_cast<float>(power_of(std::min(kHissMost, kHiss + kHissRise * z))));
  }
  const std::size_t size = static_cast<std::size_t>(n_rows_) * stride_;
  lobes_.resize(size);
  haze_.resize(size);
  make_pattern(transducer);
  place(Pose::Identity());
}

void Clutter::make_pattern(const Transducer& transducer) {
  const double width = kTwoWayWidth * transducer.wavelength() * transducer.f_number;
  const double pulse = transducer.pulse_cycles * transducer.wavelength() / 2;
  const auto across = unit_kernel(std::max(0.4, kSigmaPerWidth * width / pitch_));
  const auto along = unit_kernel(std::max(0.4, kSigmaPerWidth * pulse / sample_depth_));
  for (const bool real : {true, false}) {
    const auto noise = smooth_noise(mix_bits(seed_ + (real ? 0 : 1)),
                                    static_cast<std::size_t>(n_lines_), n_samples_, across, along);
    auto& pattern = real ? pattern_re_ : pattern_im_;
    pattern.resize(2 * noise.size());
    for (std::size_t i = 0; i < noise.size(); ++i) {
      const auto whole = static_cast<std::int8_t>(
          std::clamp(std::lround(static_cast<double>(noise[i]) * kPatternUnit), -127L, 127L));
      const std::size_t at = i / n_samples_ * 2 * n_samples_ + i % n_samples_;
      pattern[at] = pattern[at + n_samples_] = whole;
    }
  }
}

void Clutter::place(const Pose& X_JP) noexcept {
  const Vec3 p_P = X_JP.linear().transpose() * X_JP.translation();  // along the probe's own axes
  const double slice = p_P.y() / kSlice;
  const double before = std::floor(slice);
  const double turn = (slice - before) * std::numbers::pi / 2;
  const auto wrapped = [](double value, double period) {
    return value - period * std::floor(value / period);
  };
  for (std::size_t k = 0; k < 2; ++k) {  // each slice has the pattern from another place on
    const auto of_slice = static_cast<std::int64_t>(before) + static_cast<std::int64_t>(k);
    const std::uint64_t bits = mix_bits(seed_ ^ static_cast<std::uint64_t>(of_slice));
    const double lines = std::round(p_P.x() / pitch_) + static_cast<double>(bits % 4096);
    const double samples =
        std::round(p_P.z() / sample_depth_) + static_cast<double>((bits >> 20U) % 16384);
    Layer& layer = layers_[k];
    layer.line = static_cast<int>(wrapped(lines, n_lines_));
    layer.sample = static_cast<std::size_t>(wrapped(samples, static_cast<double>(n_samples_)));
    layer.weight = static_cast<float>((k == 0 ? std::cos(turn) : std::sin(turn)) /
                                      (std::numbers::sqrt2 * kPatternUnit));
  }
}

/// A two-sided exponential over the cell rows, of unit sum, in place.
void Clutter::spread_across(BlockWorkers& workers, std::vector<float>& cells, float keep) const {
  const float unit = (1 - keep) * (1 - keep);
  workers.for_blocks(static_cast<int>(n_columns_), [&](int, int first, int last) {
    std::array<float, BlockWorkers::kBlock> carried{};
    const auto n = static_cast<std::size_t>(last - first);
    for (int k = 0; k < n_rows_; ++k) {  // what comes from the left
      float* at = row(cells, k) + first;
      for (std::size_t j = 0; j < n; ++j) at[j] = carried[j] = at[j] + keep * carried[j];
    }
    carried.fill(0);
    for (int k = n_rows_ - 1; k >= 0; --k) {  // and, of all that, from the right
      float* at = row(cells, k) + first;
      for (std::size_t j = 0; j < n; ++j) at[j] = carried[j] = keep * carried[j] + unit * at[j];
    }
  });
}

void Clutter::gather(BlockWorkers& workers, std::span<const float> envelope) {
  workers.for_blocks(n_rows_, [&](int, int first, int last) {
    for (int k = first; k < last; ++k) {
      float* lobe = row(lobes_, k);
      float* haze = row(haze_, k);
      const int l0 = k * cell_lines_;
      const int l1 = std::min(n_lines_, l0 + cell_lines_);
      float behind = 0;
      for (std::size_t j = 0; j < n_columns_; ++j) {
        const std::size_t i0 = j * cell_samples_;
        const std::size_t i1 = std::min(n_samples_, i0 + cell_samples_);
        float sum = 0;
        for (int l = l0; l < l1; ++l) {
          const float* at = envelope.data() + static_cast<std::size_t>(l) * n_samples_;
          for (std::size_t i = i0; i < i1; ++i) sum += at[i] * at[i];
        }
        const float mean = std::min(
            kMost, sum / static_cast<float>((i1 - i0) * static_cast<std::size_t>(l1 - l0)));
        lobe[j] = mean;
        haze[j] = behind;
        behind = haze_keep_ * behind + (1 - haze_keep_) * mean;
      }
    }
  });
  spread_across(workers, lobes_, lobe_keep_);
  spread_across(workers, haze_, blur_keep_);
  const auto lobes = static_cast<float>(power_of(kLobes));
  const auto haze = static_cast<float>(power_of(kHaze));
  workers.for_blocks(n_rows_, [&](int, int first, int last) {
    for (int k = first; k < last; ++k) {
      float* lobe = row(lobes_, k);
      const float* late = row(haze_, k);
      for (std::size_t j = 0; j < n_columns_; ++j)
        lobe[j] = lobes * lobe[j] + haze * late[j] + floor_[j];
      lobe[n_columns_] = lobe[n_columns_ - 1];
    }
  });
}

Clutter::Rows Clutter::rows_of(int l) const noexcept {
  const float at = (static_cast<float>(l) + 0.5F) / static_cast<float>(cell_lines_) - 0.5F;
  const int first = std::clamp(static_cast<int>(std::floor(at)), 0, n_rows_ - 1);
  const int second = std::min(first + 1, n_rows_ - 1);
  return {first, second, std::clamp(at - static_cast<float>(first), 0.0F, 1.0F)};
}

double Clutter::mean_power(int l, int sample) const noexcept {
  const Rows rows = rows_of(l);
  const std::size_t j = static_cast<std::size_t>(sample) / cell_samples_;
  const auto at = [&](int k) {
    return static_cast<double>(lobes_[static_cast<std::size_t>(k) * stride_ + j]);
  };
  return at(rows.first) + static_cast<double>(rows.share) * (at(rows.second) - at(rows.first));
}

void Clutter::add(std::span<const float> envelope, int l, std::span<float> power) const noexcept {
  const Rows rows = rows_of(l);
  const float* a = lobes_.data() + static_cast<std::size_t>(rows.first) * stride_;
  const float* b = lobes_.data() + static_cast<std::size_t>(rows.second) * stride_;
  const float step = 1.0F / static_cast<float>(cell_samples_);
  for (std::size_t j = 0; j < n_columns_; ++j) {
    const float from = a[j] + rows.share * (b[j] - a[j]);
    const float to = a[j + 1] + rows.share * (b[j + 1] - a[j + 1]);
    const std::size_t i0 = j * cell_samples_;
    const std::size_t n = std::min(n_samples_ - i0, cell_samples_);
    for (std::size_t i = 0; i < n; ++i)
      power[i0 + i] = from + (to - from) * step * static_cast<float>(i);
  }
  std::array<PatternRow, 2> pattern{};
  for (std::size_t k = 0; k < 2; ++k) {
    const Layer& layer = layers_[k];
    const auto line = static_cast<std::size_t>((l + layer.line) % n_lines_);
    const std::size_t at = line * 2 * n_samples_ + layer.sample;
    pattern[k] = {pattern_re_.data() + at, pattern_im_.data() + at, layer.weight};
  }
  add_speckled(envelope.data(), pattern[0], pattern[1], power.data(), n_samples_);
}

}  // namespace artus
