// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <span>

namespace artus {

/// -45 dB: echoes above this show in colour. assumed
inline constexpr float kColourThreshold = 5.6e-3F;

/// What moves on one scanline, see Frame::velocity and Frame::motion_db.
struct MotionSpan {
  std::span<float> velocity;
  std::span<float> power_db;
};

/// Colour Doppler of one scanline: what moves at `toward` (m/s, toward the probe) shows where its
/// echo (re, im) is strong enough after `time_gain`, unless it is too slow for the wall filter.
/// Velocities beyond `limit` wrap round, as the phase between two pulses does. Fills `velocity`
/// (m/s; NaN: nothing moves) and `power_db` of `found`. Spans have one length.
void detect_motion(std::span<const float> re, std::span<const float> im,
                   std::span<const float> time_gain, double toward, double limit,
                   const MotionSpan& found) noexcept;

/// m/s as shown: velocities beyond `limit` wrap round.
[[nodiscard]] double wrap_velocity(double toward, double limit) noexcept;

/// Whether what moves at `speed` (m/s) may show in any direction, or is too slow for the wall
/// filter.
[[nodiscard]] bool may_show_motion(double speed, double limit) noexcept;

}  // namespace artus
