// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <filesystem>
#include <vector>

#include "artus/core/result.h"
#include "artus/echo/frame.h"

namespace artus {

struct StrainParams {
  double window = 1.5e-3;        ///< m, length of a matched piece of line
  double step = 0.25e-3;         ///< m between such pieces
  int lines = 3;                 ///< scanlines beside each other that are matched as one, odd
  double search = 0.2e-3;        ///< m, beyond what the piece above moved
  double fit = 2e-3;             ///< m, length over which displacement is made into strain
  double min_correlation = 0.8;  ///< below it there is no strain
};

/// How far tissue moved along each scanline between two frames, and how much it was strained.
/// All (n_lines, n_depths), depth fastest; depth k lies at first_depth + k step.
struct StrainImage {
  int n_lines = 0;
  int n_depths = 0;
  double first_depth = 0;           ///< m of displayed depth
  double step = 0;                  ///< m
  std::vector<float> displacement;  ///< m, away from the probe positive
  std::vector<float> strain;       ///< of length along the line, compression negative; NaN: unknown
  std::vector<float> correlation;  ///< 0..1 of the matched pieces
};

/// Compares two frames of one probe and one setting: complex cross-correlation of pieces of line,
/// its peak by a parabola, from the face downward, each piece looked for where the one above was
/// found; strain by least squares over `fit`. Requires: frames of one size (std::invalid_argument).
/// Cost: some 100 ms. Source [Ophir1991], here with complex echoes.
[[nodiscard]] StrainImage compute_strain(const Frame& before, const Frame& after,
                                         const StrainParams& params = {});

/// The strain as CSV: line, depth_mm, displacement_um, strain_percent, correlation. Errors:
/// unreadable.
[[nodiscard]] Result<void> write_strain(const StrainImage& image,
                                        const std::filesystem::path& file);

}  // namespace artus
