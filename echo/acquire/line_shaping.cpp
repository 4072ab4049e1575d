// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/echo/acquire/line_shaping.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "artus/detail/core/noise.h"
#include "artus/detail/echo/acquire/doppler.h"
#include "artus/detail/echo/medium/scatter_field.h"
#include "artus/detail/echo/medium/simd.h"

namespace artus {
namespace {

ARTUS_SIMD
void detect(const float* re, const float* im, const float* gain, float* envelope,
            std::size_t n) noexcept {
  for (std::size_t i = 0; i < n; ++i) {
    envelope[i] = gain[i] * std::sqrt(re[i] * re[i] + im[i] * im[i]);
  }
}

/// A line's echoes.
struct EchoRow {
  const float* re;
  const float* im;
};

/// Adds the envelope of `own` plus `more` to the one there, and scales the sum.
ARTUS_SIMD
void add_detected(const EchoRow& own, const EchoRow& more, const float* gain, float scale,
                  float* envelope, std::size_t n) noexcept {
  for (std::size_t i = 0; i < n; ++i) {
    const float a = own.re[i] + more.re[i];
    const float b = own.im[i] + more.im[i];
    envelope[i] = scale * (envelope[i] + gain[i] * std::sqrt(a * a + b * b));
  }
}

std::span<float> row(std::vector<float>& data, int l, std::size_t n) {
  return std::span(data).subspan(static_cast<std::size_t>(l) * n, n);
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

LineShaping::LineShaping(const Transducer& transducer, const ImageSettings& settings,
                         const BeamShape& shape)
    : transducer_(transducer),
      settings_(settings),
      shape_(&shape),
      time_gain_(make_time_gain(transducer, settings)),
      noise_gain_(static_cast<std::size_t>(settings.n_samples),
                  static_cast<float>(std::pow(10.0, settings.noise_db / 20))) {
  const auto size =
      static_cast<std::size_t>(transducer.n_lines) * static_cast<std::size_t>(settings.n_samples);
  wide_.resize(size);
  if (settings.look == Look::compound) {
    set_re_.resize(size);
    set_im_.resize(size);
  }
  if (settings.doppler) motion_.resize(size);
}

void LineShaping::set_time_gain(const LiveSettings& live) {
  static_cast<LiveSettings&>(settings_) = live;
  time_gain_ = make_time_gain(transducer_, settings_);
}

void LineShaping::run(const Acquisition& acquired, const EchoBody& body, BlockWorkers& workers,
                      Frame& frame) {
  const std::size_t n = time_gain_.size();
  const int n_lines = acquired.n_lines();
  workers.for_blocks(n_lines, [&](int, int first, int last) {
    for (int l = first; l < last; ++l) {
      const auto wide = row(wide_, l, n);
      const auto re = row(frame.in_phase, l, n);
      const auto im = row(frame.quadrature, l, n);
      shape_->across(acquired.in_phase(), n_lines, l, wide);
      acquired.add_reflectors(body, l, wide);
      shape_->along(wide, re);
      shape_->across(acquired.quadrature(), n_lines, l, wide);
      shape_->along(wide, im);
      add_white_noise(mix_bits(settings_.seed), l, noise_gain_, re, im);
      detect(re.data(), im.data(), time_gain_.data(), row(frame.envelope, l, n).data(), n);
      average(acquired, l, frame);
    }
  });
}

/// Makes the envelope of line `l` the mean over all sets of scatterers; the beam and the pulse are
/// linear, so they need to see the differences between sets alone.
void LineShaping::average(const Acquisition& acquired, int l, Frame& frame) {
  const std::size_t n = time_gain_.size();
  const std::size_t sets = acquired.more_in_phase().size();
  for (std::size_t k = 0; k < sets; ++k) {
    const auto wide = row(wide_, l, n);
    const auto re = row(set_re_, l, n);
    const auto im = row(set_im_, l, n);
    shape_->across(acquired.more_in_phase()[k], acquired.n_lines(), l, wide);
    shape_->along(wide, re);
    shape_->across(acquired.more_quadrature()[k], acquired.n_lines(), l, wide);
    shape_->along(wide, im);
    const float scale = k + 1 == sets ? 1 / static_cast<float>(sets + 1) : 1.0F;
    add_detected({row(frame.in_phase, l, n).data(), row(frame.quadrature, l, n).data()},
                 {re.data(), im.data()}, time_gain_.data(), scale, row(frame.envelope, l, n).data(),
                 n);
  }
}

void LineShaping::find_motion(const Acquisition& acquired, const std::optional<Vec3>& v_P,
                              BlockWorkers& workers, Frame& frame) {
  if (!v_P || !may_show_motion(v_P->norm(), settings_.doppler_limit)) {
    std::fill(frame.velocity.begin(), frame.velocity.end(),
              std::numeric_limits<float>::quiet_NaN());
    return;
  }
  const std::size_t n = time_gain_.size();
  const int n_lines = acquired.n_lines();
  workers.for_blocks(n_lines, [&](int, int first, int last) {
    for (int l = first; l < last; ++l) {
      const auto wide = row(wide_, l, n);
      const auto re = row(frame.velocity, l, n);
      const auto im = row(motion_, l, n);
      shape_->across(acquired.moving_in_phase(), n_lines, l, wide);
      shape_->along(wide, re);
      shape_->across(acquired.moving_quadrature(), n_lines, l, wide);
      shape_->along(wide, im);
      const Vec3& direction = acquired.lines()[static_cast<std::size_t>(l)].line.direction;
      detect_motion(re, im, time_gain_, -v_P->dot(direction), settings_.doppler_limit,
                    {re, row(frame.motion_db, l, n)});
    }
  });
}

}  // namespace artus
