// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/echo/probe/beam_profile.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>

namespace artus {
namespace {

constexpr int kDepths = 56;
constexpr int kOffsets = 48;
constexpr int kApertureNodes = 160;
constexpr int kFrequencies = 5;
constexpr double kNearest = 0.67;  // of the height: nearer, the paraxial field no longer holds

/// One-way field intensity of a cylindrically focused strip at (y, z): the paraxial (Fresnel)
/// integral over the element's height, whose square of magnitude is the two-way amplitude.
double two_way_amplitude(double y, double z, double height, double focus, double wave_number) {
  std::complex<double> sum = 0;
  for (int i = 0; i < kApertureNodes; ++i) {
    const double s = height * ((i + 0.5) / kApertureNodes - 0.5);
    const double path = (y - s) * (y - s) / (2 * z) - s * s / (2 * focus);
    sum += std::polar(1.0, wave_number * path);
  }
  return std::norm(sum);
}

/// Where a falling profile last passes half its maximum, m (twice that: the full width).
double full_width(const float* amplitude, int n, double step) {
  const float half = 0.5F * *std::max_element(amplitude, amplitude + n);
  for (int i = n - 2; i >= 0; --i) {
    if (amplitude[i] < half) continue;
    const double t = (amplitude[i] - half) / (amplitude[i] - amplitude[i + 1]);
    return 2 * step * (i + t);
  }
  return 2 * step;
}

}  // namespace

BeamProfile::BeamProfile(const Transducer& transducer, double depth)
    : transducer_(transducer), n_z_(kDepths), n_y_(kOffsets) {
  const double height = transducer.elevation_height;
  const double focus = transducer.elevation_focus;
  const double spread = std::max(1.0, std::abs(depth / focus - 1));
  z_step_ = depth / (n_z_ - 1);
  y_step_ = 0.75 * height * spread / (n_y_ - 1);
  const double spectrum_sigma = transducer.spectrum_sigma();
  amplitude_.assign(static_cast<std::size_t>(n_z_) * n_y_, 0.0F);
  width_.assign(n_z_, 0.0);
  for (int iz = 0; iz < n_z_; ++iz) {
    const double z = std::max(z_step_ * iz, kNearest * height);
    float* row = amplitude_.data() + static_cast<std::size_t>(iz) * n_y_;
    for (int iy = 0; iy < n_y_; ++iy) {
      double sum = 0;
      for (int k = 0; k < kFrequencies; ++k) {
        constexpr int kMiddle = kFrequencies / 2;
        const double u = 0.8 * (k - kMiddle);  // standard deviations from the centre
        const double wave_number = 2 * std::numbers::pi *
                                   (transducer.frequency + u * spectrum_sigma) /
                                   kDisplaySpeedOfSound;
        sum +=
            std::exp(-u * u / 2) * two_way_amplitude(y_step_ * iy, z, height, focus, wave_number);
      }
      row[iy] = static_cast<float>(sum);
    }
    const float peak = *std::max_element(row, row + n_y_);
    std::for_each(row, row + n_y_, [peak](float& a) { a /= peak; });
    width_[iz] = full_width(row, n_y_, y_step_);
  }
}

double BeamProfile::lateral_width(double z) const noexcept {
  const double one_way = kTwoWayWidth * std::numbers::sqrt2 * transducer_.wavelength();
  const double f_number = std::max(transducer_.f_number, z / transducer_.max_aperture);
  const double receive = one_way * f_number;
  const double focus = transducer_.transmit_focus;
  if (focus == 0) return receive / std::numbers::sqrt2;
  const double aperture = std::min(focus / transducer_.f_number, transducer_.max_aperture);
  const double transmit = std::hypot(one_way * z / aperture, aperture * (1 - z / focus));
  return 1 / std::hypot(1 / receive, 1 / transmit);
}

double BeamProfile::elevation_width(double z) const noexcept {
  const double place = std::clamp(z / z_step_, 0.0, n_z_ - 1.001);
  const auto i = static_cast<std::size_t>(place);
  const double t = place - static_cast<double>(i);
  return (1 - t) * width_[i] + t * width_[i + 1];
}

double BeamProfile::elevation_amplitude(double y, double z) const noexcept {
  const double column = std::abs(y) / y_step_;
  if (!(column < n_y_ - 1)) return 0;
  const double row = std::clamp(z / z_step_, 0.0, n_z_ - 1.001);
  const auto iy = static_cast<std::size_t>(column);
  const auto iz = static_cast<std::size_t>(row);
  const double ty = column - static_cast<double>(iy);
  const double tz = row - static_cast<double>(iz);
  const float* a = amplitude_.data() + iz * static_cast<std::size_t>(n_y_) + iy;
  const float* b = a + n_y_;
  return (1 - tz) * ((1 - ty) * a[0] + ty * a[1]) + tz * ((1 - ty) * b[0] + ty * b[1]);
}

double BeamProfile::elevation_share(double y, double z, double radius) const noexcept {
  double sum = 0;
  double centred = 0;
  for (const double offset : {-0.8, -0.4, 0.0, 0.4, 0.8}) {
    sum += elevation_amplitude(y + offset * radius, z);
    centred += elevation_amplitude(offset * radius, z);
  }
  return std::min(1.0, sum / centred);
}

}  // namespace artus
