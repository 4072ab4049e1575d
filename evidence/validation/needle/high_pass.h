// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <cmath>
#include <cstddef>

namespace artus {

/// Butterworth high-pass of order 8 (bilinear, direct form II transposed, from rest), steep enough
/// that "above 20 Hz" leaves out a hand's tremor at 8 to 12 Hz: 12 Hz passes by 0.017, 10 Hz by
/// 0.004 of its amplitude; a filter of order 2 lets a third and a quarter through. Requires:
/// 0 < cut_hz < rate_hz / 2.
class HighPass {
 public:
  HighPass(double cut_hz, double rate_hz) {
    constexpr double kPi = 3.141592653589793;
    const double k = std::tan(kPi * cut_hz / rate_hz);
    for (std::size_t i = 0; i < sections_.size(); ++i) {
      // Pole pairs of the Butterworth circle: 1/Q = 2 cos(pi (2 i + 1) / (2 * 8)).
      const double inverse_q =
          2 * std::cos(kPi * static_cast<double>(2 * i + 1) / (4.0 * kSections));
      const double norm = 1 / (1 + inverse_q * k + k * k);
      sections_[i] = {norm, 2 * (k * k - 1) * norm, (1 - inverse_q * k + k * k) * norm, 0, 0};
    }
  }

  double step(double x) noexcept {
    for (Section& s : sections_) {
      const double y = s.b * x + s.s1;
      s.s1 = -2 * s.b * x - s.a1 * y + s.s2;
      s.s2 = s.b * x - s.a2 * y;
      x = y;
    }
    return x;
  }

 private:
  static constexpr std::size_t kSections = 4;
  struct Section {
    double b = 0;  // b0 = b2, b1 = -2 b
    double a1 = 0;
    double a2 = 0;
    double s1 = 0;
    double s2 = 0;
  };
  std::array<Section, kSections> sections_{};
};

/// N^2 s above `cut_hz` of a straight line of force that breaks by `slope`, N/s: a corner has the
/// spectrum slope / w^2, so slope^2 / (3 pi w^3). What a law made of straight pieces has without
/// any chatter.
[[nodiscard]] inline double corner_energy(double slope, double cut_hz) noexcept {
  constexpr double kPi = 3.141592653589793;
  const double w = 2 * kPi * cut_hz;
  return slope * slope / (3 * kPi * w * w * w);
}

}  // namespace artus
