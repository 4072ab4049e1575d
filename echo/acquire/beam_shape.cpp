// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/echo/acquire/beam_shape.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <type_traits>

#include "artus/detail/echo/medium/scatter_field.h"
#include "artus/detail/echo/medium/simd.h"
#include "artus/detail/echo/probe/gaussian.h"

namespace artus {
namespace {

constexpr double kOutermost = 0.9;   // widths from the axis: the beam is 20 dB down there
constexpr double kPulseTail = 3;     // standard deviations kept of the pulse
constexpr double kBeamTail = 4.2;    // standard deviations from which the beam is left out: -77 dB
constexpr double kLongest = 1.25;    // of the displayed depth, as far as beams are followed
constexpr std::size_t kPadding = 8;  // floats behind the last weight that may be read
constexpr int kMaxReach = 16;        // lines
constexpr double kSmallest = 10e-6;  // m, of a scatterer

constexpr std::size_t kAcross = 32;  // samples whose sums stay in registers

/// What the beam mixes of the lines around one.
struct AcrossLines {
  const float* kernel;  // (reach + 1, n), of lines 0, 1.. beside it
  const float* middle;  // the line's own samples
  std::ptrdiff_t n;     // samples a line
  int before;           // lines before it that are mixed
  int behind;
};

/// out[first..] = the weighted sum over the lines, `count` <= kAcross samples.
template <class Count>
[[gnu::always_inline]] inline void mix_some(const AcrossLines& lines, std::ptrdiff_t first,
                                            Count count, float* out) noexcept {
  float sum[kAcross];
  const float* const own = lines.middle + first;
  for (std::size_t i = 0; i < count; ++i)
    sum[i] = lines.kernel[first + static_cast<std::ptrdiff_t>(i)] * own[i];
  const int both = std::min(lines.before, lines.behind);
  for (int k = 1; k <= both; ++k) {
    const float* const weight = lines.kernel + k * lines.n + first;
    const float* const left = own - k * lines.n;
    const float* const right = own + k * lines.n;
    for (std::size_t i = 0; i < count; ++i) sum[i] += weight[i] * (left[i] + right[i]);
  }
  const int side = lines.before > lines.behind ? -1 : 1;
  for (int k = both + 1; k <= std::max(lines.before, lines.behind); ++k) {
    const float* const weight = lines.kernel + k * lines.n + first;
    const float* const one = own + side * k * lines.n;
    for (std::size_t i = 0; i < count; ++i) sum[i] += weight[i] * one[i];
  }
  for (std::size_t i = 0; i < count; ++i) out[first + static_cast<std::ptrdiff_t>(i)] = sum[i];
}

ARTUS_SIMD
void mix_lines(const AcrossLines& lines, float* out) noexcept {
  constexpr auto kStep = static_cast<std::ptrdiff_t>(kAcross);
  std::ptrdiff_t first = 0;
  for (; first + kStep <= lines.n; first += kStep)
    mix_some(lines, first, std::integral_constant<std::size_t, kAcross>{}, out);
  if (first < lines.n) mix_some(lines, first, static_cast<std::size_t>(lines.n - first), out);
}

ARTUS_SIMD
void scale(float weight, const float* in, float* out, std::size_t n) noexcept {
  for (std::size_t i = 0; i < n; ++i) out[i] = weight * in[i];
}

ARTUS_SIMD
void scale_add_pair(float weight, const float* before, const float* behind, float* out,
                    std::size_t n) noexcept {
  for (std::size_t i = 0; i < n; ++i) out[i] += weight * (before[i] + behind[i]);
}

/// Power of a weighted sum of unit scatterers at `spacing`, of which `shared(distance, cell)` is
/// the correlation.
template <class T>
double shared_power(const std::vector<T>& weights, double spacing, double cell,
                    double (*shared)(double, double) noexcept) {
  double sum = 0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    for (std::size_t j = 0; j < weights.size(); ++j) {
      const double apart = spacing * (static_cast<double>(i) - static_cast<double>(j));
      sum +=
          shared(apart, cell) * static_cast<double>(weights[i]) * static_cast<double>(weights[j]);
    }
  }
  return sum;
}

}  // namespace

BeamShape::BeamShape(const Transducer& transducer, const ImageSettings& settings)
    : profile_(transducer, settings.depth * kLongest),
      is_raw_(settings.look == Look::raw),
      n_samples_(settings.n_samples),
      sample_depth_(settings.depth / settings.n_samples),
      pitch_(transducer.pitch()),
      curvature_(transducer.radius > 0 ? 1 / transducer.radius : 0) {
  size_scatterers(transducer);
  tabulate_pulse(transducer);
  tabulate_lateral(transducer.n_lines);
  nodes_ = {0, std::min(transducer.elevation_focus, 0.5 * settings.depth * kLongest),
            settings.depth * kLongest};
  for (const double z : nodes_) node_width_.push_back(profile_.elevation_width(z));
  tabulate_planes(settings);
}

void BeamShape::size_scatterers(const Transducer& transducer) {
  const double pulse = transducer.pulse_cycles * transducer.wavelength() / 2;
  const double beam = profile_.lateral_width(0);
  scatterer_.axial = std::max(0.5 * pulse, kSmallest);
  scatterer_.lateral = std::clamp(pitch_, 0.3 * beam, 0.65 * beam);
  scatterer_.elevation = profile_.elevation_width(transducer.elevation_focus);
}

void BeamShape::tabulate_pulse(const Transducer& transducer) {
  const double width = transducer.pulse_cycles * transducer.wavelength() / 2;
  const double sigma = width * kSigmaPerWidth / sample_depth_;
  const int half = std::max(1, static_cast<int>(std::ceil(kPulseTail * sigma)));
  for (int k = -half; k <= half; ++k) {
    pulse_.push_back(static_cast<float>(std::exp(-0.5 * k * k / (sigma * sigma))));
  }
}

void BeamShape::tabulate_lateral(int n_lines) {
  const auto n = static_cast<std::size_t>(n_samples_);
  std::vector<double> sigma(n);  // in lines
  for (std::size_t i = 0; i < n; ++i) {
    const double z = static_cast<double>(i) * sample_depth_;
    sigma[i] = profile_.lateral_width(z) * kSigmaPerWidth / line_spacing(z);
  }
  const double widest = *std::max_element(sigma.begin(), sigma.end());
  reach_ = std::clamp(static_cast<int>(std::ceil(kBeamTail * widest)) - 1, 1,
                      std::min(kMaxReach, std::max(1, n_lines - 1)));
  kernel_.assign(static_cast<std::size_t>(reach_ + 1) * n, 0.0F);
  for (std::size_t i = 0; i < n; ++i) {
    const double narrow = -0.5 / (sigma[i] * sigma[i]);
    double sum = 0;
    for (int k = -reach_; k <= reach_; ++k) sum += std::exp(narrow * k * k);
    for (int k = 0; k <= reach_; ++k) {
      kernel_[static_cast<std::size_t>(k) * n + i] =
          static_cast<float>(std::exp(narrow * k * k) / sum);
    }
  }
}

/// The weight of plane `p`'s scatterers: with the power of half of what lies between it and the
/// next planes that are heard.
double BeamShape::heard_weight(int p, std::span<const double> weight) const noexcept {
  const auto power = [&](int q) {
    const auto at = static_cast<std::size_t>(q);
    return q < 0 || at >= weight.size() || hears_speckle(q) ? 0 : weight[at] * weight[at];
  };
  const double own = weight[static_cast<std::size_t>(p)];
  if (!hears_speckle(p)) return 0;
  return std::sqrt(own * own + 0.5 * (power(p - 1) + power(p + 1)));
}

void BeamShape::tabulate_planes(const ImageSettings& settings) {
  const int planes = settings.n_planes;
  const auto n = static_cast<std::size_t>(n_samples_);
  for (int p = 0; p < planes; ++p) {
    offsets_.push_back(planes == 1 ? 0 : kOutermost * (2.0 * p / (planes - 1) - 1));
  }
  echo_weight_.assign(static_cast<std::size_t>(planes) * n, 0.0F);
  speckle_weight_.assign(static_cast<std::size_t>(planes) * n + kPadding, 0.0F);
  const double pulse_power =
      shared_power(pulse_, sample_depth_, scatterer_.axial, ScatterField::shared_axially);
  std::vector<double> lateral(static_cast<std::size_t>(2 * reach_ + 1));
  std::vector<double> weight(static_cast<std::size_t>(planes));
  std::vector<double> heard(weight.size());
  for (std::size_t i = 0; i < n; ++i) {
    const double z = static_cast<double>(i) * sample_depth_;
    double sum = 0;
    double plane_power = 0;
    for (int p = 0; p < planes; ++p) {
      const auto at = static_cast<std::size_t>(p);
      weight[at] = std::max(1e-3, profile_.elevation_amplitude(plane_elevation(p, z), z));
      sum += weight[at];
    }
    for (int p = 0; p < planes; ++p) heard[static_cast<std::size_t>(p)] = heard_weight(p, weight);
    for (int p = 0; p < planes; ++p) {
      const double own = heard[static_cast<std::size_t>(p)];
      plane_power += own * own;
      for (int q = 0; q < p; ++q) {
        const double apart = plane_elevation(p, z) - plane_elevation(q, z);
        plane_power += 2 * own * heard[static_cast<std::size_t>(q)] *
                       ScatterField::shared(apart, scatterer_.elevation);
      }
    }
    for (int k = -reach_; k <= reach_; ++k) {
      const int at_k = k + reach_;
      lateral[static_cast<std::size_t>(at_k)] =
          kernel_[static_cast<std::size_t>(std::abs(k)) * n + i];
    }
    const double lateral_power =
        shared_power(lateral, line_spacing(z), scatterer_.lateral, ScatterField::shared);
    const double unit = 1 / std::sqrt(plane_power * lateral_power * pulse_power);
    for (std::size_t p = 0; p < weight.size(); ++p) {
      echo_weight_[p * n + i] = static_cast<float>(weight[p] / sum);
      speckle_weight_[p * n + i] = static_cast<float>(heard[p] * unit);
    }
  }
}

double BeamShape::plane_elevation(int p, double z) const noexcept {
  const std::size_t i = z < nodes_[1] ? 0 : 1;
  const double t = (z - nodes_[i]) / (nodes_[i + 1] - nodes_[i]);
  return plane_offset(p) * (node_width_[i] + t * (node_width_[i + 1] - node_width_[i]));
}

std::span<const float> BeamShape::echo_weight(int p) const noexcept {
  const auto n = static_cast<std::size_t>(n_samples_);
  return {echo_weight_.data() + static_cast<std::size_t>(p) * n, n};
}

std::span<const float> BeamShape::speckle_weight(int p) const noexcept {
  const auto n = static_cast<std::size_t>(n_samples_);
  return {speckle_weight_.data() + static_cast<std::size_t>(p) * n, n};
}

double BeamShape::lateral_amplitude(double offset, double z) const noexcept {
  const double u = offset / (profile_.lateral_width(z) * kSigmaPerWidth);
  return std::exp(-0.5 * u * u);
}

void BeamShape::across(std::span<const float> lines, int n_lines, int line,
                       std::span<float> out) const noexcept {
  const auto n = static_cast<std::ptrdiff_t>(n_samples_);
  mix_lines({kernel_.data(), lines.data() + line * n, n, std::min(reach_, line),
             std::min(reach_, n_lines - 1 - line)},
            out.data());
}

void BeamShape::along(std::span<const float> in, std::span<float> out) const noexcept {
  const std::size_t n = in.size();
  const std::size_t half = pulse_.size() / 2;
  const float* weight = pulse_.data() + half;
  if (n > 2 * half) {
    const std::size_t inner = n - 2 * half;
    scale(weight[0], in.data() + half, out.data() + half, inner);
    for (std::size_t k = 1; k <= half; ++k) {
      scale_add_pair(weight[k], in.data() + half - k, in.data() + half + k, out.data() + half,
                     inner);
    }
  }
  const auto near_end = [&](std::size_t i) {
    float sum = weight[0] * in[i];
    for (std::size_t k = 1; k <= half; ++k) {
      sum += weight[k] * ((i >= k ? in[i - k] : 0.0F) + (i + k < n ? in[i + k] : 0.0F));
    }
    out[i] = sum;
  };
  for (std::size_t i = 0; i < std::min(half, n); ++i) near_end(i);
  for (std::size_t i = std::max(half, n > half ? n - half : 0); i < n; ++i) near_end(i);
}

}  // namespace artus
