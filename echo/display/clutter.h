// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "artus/core/geometry.h"
#include "artus/detail/echo/acquire/block_workers.h"
#include "artus/echo/image_settings.h"
#include "artus/echo/transducer.h"

namespace artus {

/// What a scanner shows where nothing should be: the beam's side lobes hear what lies beside (a
/// two-sided exponential across lines), sound that was thrown back and forth above comes later (a
/// one-sided exponential along depth, spread over lines), and the receiver hisses. It is added to
/// the echoes' power before they are compressed, speckled by a pattern that stays in place in the
/// body while the probe slides and does not change while it rests.
class Clutter {
 public:
  /// Requires: valid transducer and settings. Cost: some 10 ms.
  Clutter(const Transducer& transducer, const ImageSettings& settings);

  /// Finds the clutter of a frame whose envelopes (n_lines, n_samples) are given. Cost: 1 ns a
  /// sample.
  void gather(BlockWorkers& workers, std::span<const float> envelope);

  /// Where the probe is, for the pattern.
  void place(const Pose& X_JP) noexcept;

  /// Writes the power of line `l`: squared envelope plus clutter. Cost: 1 ns a sample.
  void add(std::span<const float> envelope, int l, std::span<float> power) const noexcept;

  /// The clutter's mean power at a line's sample, without its speckle; mirror = 1.
  [[nodiscard]] double mean_power(int l, int sample) const noexcept;

 private:
  struct Rows;
  void make_pattern(const Transducer& transducer);
  void spread_across(BlockWorkers& workers, std::vector<float>& cells, float keep) const;
  [[nodiscard]] float* row(std::vector<float>& cells, int k) const noexcept {
    return cells.data() + static_cast<std::size_t>(k) * stride_;
  }
  [[nodiscard]] Rows rows_of(int l) const noexcept;

  int n_lines_;
  std::size_t n_samples_;
  int cell_lines_;                       // lines in a cell
  std::size_t cell_samples_;             // samples in a cell
  int n_rows_;                           // cells across
  std::size_t n_columns_;                // cells along
  std::size_t stride_;                   // n_columns_ and room to read beyond the last
  double pitch_;                         // m between lines
  double sample_depth_;                  // m
  float lobe_keep_;                      // of the side lobes from cell row to cell row
  float haze_keep_;                      // of the haze from cell to cell along the line
  float blur_keep_;                      // of its spread across
  std::vector<float> floor_;             // (n_columns) power of the receiver's noise
  std::vector<float> lobes_;             // (n_rows, stride), then all of the clutter
  std::vector<float> haze_;              // (n_rows, stride)
  std::vector<std::int8_t> pattern_re_;  // (n_lines, 2 n_samples): each row twice, to wrap round
  std::vector<std::int8_t> pattern_im_;
  struct Layer {
    int line = 0;
    std::size_t sample = 0;
    float weight = 1;
  };
  std::array<Layer, 2> layers_;  // of the pattern, blended by where the probe is across its plane
  std::uint64_t seed_;
};

}  // namespace artus
