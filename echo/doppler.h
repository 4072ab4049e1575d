// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <span>

#include "artus/echo/image_settings.h"

namespace artus {

/// Colour Doppler of one scanline: what moves at `toward` (m/s, toward the probe) shows where its
/// echo (re, im) is strong enough after `time_gain`, unless it is too slow for the wall filter.
/// Velocities beyond `limit` wrap round, as the phase between two pulses does. Fills `velocity`
/// (m/s; NaN: nothing moves). Spans have one length.
void detect_motion(std::span<const float> re, std::span<const float> im,
                   std::span<const float> time_gain, double toward, double limit,
                   std::span<float> velocity) noexcept;

}  // namespace artus
