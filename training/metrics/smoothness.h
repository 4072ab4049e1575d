// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <span>

namespace artus {

/// Spectral arc length of a speed profile: K = 2^(ceil(log2 N) + 4) points of Fourier transform,
/// magnitude over its maximum M, f <= 10 Hz, from the first to the last point with M >= 0.05;
/// minus the length of that curve with frequency scaled to 0..1. Nearer to 0 is smoother; 0 for
/// fewer than two values or none that moves. `rate`: Hz. Source [Balasubramanian2012]. Cost:
/// K log K.
[[nodiscard]] double spectral_arc_length(std::span<const double> speed, double rate);

/// Log dimensionless jerk of a speed profile: -ln(T^3 / v_peak^2 sum (d2v/dt2)^2 dt), T = N dt.
/// Nearer to 0 is smoother; 0 where nothing moves or fewer than three values. `rate`: Hz. Source
/// [Balasubramanian2012].
[[nodiscard]] double log_dimensionless_jerk(std::span<const double> speed, double rate);

}  // namespace artus
