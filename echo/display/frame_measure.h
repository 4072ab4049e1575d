// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <span>
#include <vector>

#include "artus/echo/frame.h"
#include "artus/echo/image_settings.h"

/// What an acoustician reads off a frame: the measuring that gates, phantoms and tests share.
namespace artus {

/// The default settings in the raw look: the echoes as physics has them.
[[nodiscard]] ImageSettings raw_settings();

/// Settings that show bare physics: no compensation, texture, repeats, downshift or noise,
/// in the raw look.
[[nodiscard]] ImageSettings bare_settings();

/// 20 log10 of an amplitude, 10 log10 of an intensity, dB.
[[nodiscard]] double decibel(double amplitude);
[[nodiscard]] double decibel_of_intensity(double intensity);

/// One line's envelope, (n_samples).
[[nodiscard]] std::span<const float> envelope_line(const Frame& frame, int line);

/// Mean squared envelope of the samples from displayed depth `from` to `to`, m, of every line.
[[nodiscard]] double mean_intensity(const Frame& frame, double from, double to);

/// Sample of the largest envelope between two displayed depths (m) on one line, and its value.
[[nodiscard]] int find_peak(const Frame& frame, int line, double from, double to);
[[nodiscard]] double peak_value(const Frame& frame, int line, double from, double to);

struct Moments {
  double mean = 0;
  double deviation = 0;  ///< of the population
};
[[nodiscard]] Moments moments_of(std::span<const double> values);

/// y = intercept + slope x by least squares, with Pearson's correlation.
struct LineFit {
  double slope = 0;
  double intercept = 0;
  double correlation = 0;
};
/// Requires: x and y of one length, at least two different x.
[[nodiscard]] LineFit fit_line(std::span<const double> x, std::span<const double> y);

/// Where y, sampled at rising x, first passes `level` on its way down, interpolated; the last x
/// when it never does.
[[nodiscard]] double falls_to(std::span<const double> x, std::span<const double> y, double level);

/// Full width at half the maximum of a symmetric curve, sampled from its axis (x = 0) outwards.
[[nodiscard]] double full_width(std::span<const double> x, std::span<const double> y);

/// Largest distance between the distribution of `envelopes` and the Rayleigh distribution of the
/// same power (Kolmogorov and Smirnov's statistic).
[[nodiscard]] double rayleigh_distance(std::vector<double> envelopes);

}  // namespace artus
