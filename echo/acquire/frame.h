// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "artus/core/geometry.h"

namespace artus {

/// Where a point lies in the image, pixels (x right, y down).
struct PixelPoint {
  double x = 0;
  double y = 0;
};

/// What was wrong with a frame's input; bits.
struct FrameStatus {
  static constexpr std::uint32_t kOk = 0;
  /// The probe's pose was not finite, not rigid or a kilometre away: the frame is black.
  static constexpr std::uint32_t kBadProbe = 1U << 0U;
  /// The same of the needle's pose, or its velocity or shape: the frame is without it.
  static constexpr std::uint32_t kBadNeedle = 1U << 1U;
};

/// Seconds that a frame spent in each stage.
struct StageTimes {
  double lines = 0;    ///< tracing, scattering and needle
  double beam = 0;     ///< lateral and axial pulse shape, envelope
  double display = 0;  ///< compression, scan conversion
};

/// One B-mode image with every stage that led to it.
struct Frame {
  std::uint32_t status = FrameStatus::kOk;
  int n_lines = 0;
  int n_samples = 0;
  double sample_depth = 0;          ///< m of displayed depth between samples
  std::vector<float> in_phase;      ///< (n_lines, n_samples), sample fastest; before compensation
  std::vector<float> quadrature;    ///< as in_phase
  std::vector<float> envelope;      ///< as in_phase; after time gain compensation, mirror = 1
  std::vector<float> decibel;       ///< as in_phase; 20 log10 envelope + gain
  int width = 0;                    ///< pixels
  int height = 0;                   ///< pixels
  double pixel = 0;                 ///< m
  std::vector<std::uint8_t> image;  ///< (height, width), x fastest; scan-converted grey
  /// (n_lines), how well the face couples to the body there: 0 air .. 1 skin or gel.
  std::vector<float> contact;
  /// (n_lines), sample from which no sound returns; n_samples: none.
  std::vector<float> shadow_from;
  /// As in_phase: share of the sound that passes the needle, 1 without one. It comes from the
  /// geometry alone; gain and noise do not show in it.
  std::vector<float> needle_light;
  /// Where the needle's tip shows, displaced as all echoes are by refraction and the tissues'
  /// speeds of sound. Empty without a needle, where no sound reaches it, and outside the picture.
  std::optional<PixelPoint> tip_shown;
  /// As in_phase: m/s toward the probe of what moves, wrapped at doppler_limit; NaN where nothing
  /// does. Empty unless doppler is on.
  std::vector<float> velocity;
  /// As velocity: how strong the echo of what moves is, dB after time gain compensation; says
  /// something where velocity is a number.
  std::vector<float> motion_db;
};

}  // namespace artus
