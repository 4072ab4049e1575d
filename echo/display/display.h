// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "artus/detail/echo/acquire/block_workers.h"
#include "artus/detail/echo/display/clutter.h"
#include "artus/detail/echo/display/scan_converter.h"
#include "artus/detail/echo/display/speckle_reduction.h"
#include "artus/echo/frame.h"
#include "artus/echo/image_settings.h"
#include "artus/echo/transducer.h"

namespace artus {

/// 10 log10 of each power plus `gain_db`, at least -200; accurate to 0.01 dB, in place.
/// Cost: 2 ns each.
void compress_power(std::span<float> power, float gain_db) noexcept;

/// 20 log10 of each amplitude plus `gain_db`, at least -200; accurate to 0.01 dB. Cost: 2 ns each.
void compress(std::span<const float> envelope, float gain_db, std::span<float> decibel) noexcept;

/// Blends line `l` of the decibel image (n_lines, n_samples) with the mean of its 3 x 3
/// neighbourhood: `share` 0 none .. 1 the mean alone.
void smooth_line(std::span<const float> decibel, int n_lines, int l, float share,
                 std::span<float> out) noexcept;

/// The last stage, the scanner's back end: envelopes become grey pixels. Gain, dynamic range,
/// smoothing, persistence, clutter, speckle reduction, grey curve and grain act here alone; the
/// last four not in the raw look.
class Display {
 public:
  /// Requires: valid transducer and settings.
  Display(const Transducer& transducer, const ImageSettings& settings);

  /// From the next image on.
  void set(const LiveSettings& live);

  /// Fills decibel and image of the frame, seen from X_JP, from its envelope.
  void show(BlockWorkers& workers, const Pose& X_JP, Frame& frame);

  /// Blacks the frame's image out; the next image keeps nothing of those before.
  void show_nothing(Frame& frame) noexcept;

  [[nodiscard]] const ScanConverter& converter() const noexcept { return converter_; }

 private:
  void level(BlockWorkers& workers, const Pose& X_JP, Frame& frame);
  /// decibel = change(decibel), where change(l, out) makes line l of it.
  template <class Change>
  void replace_lines(BlockWorkers& workers, Frame& frame, const Change& change);
  void keep_previous(std::vector<std::uint8_t>& image);

  Look look_;
  LiveSettings live_;
  int n_lines_;
  int n_samples_;
  ScanConverter converter_;
  std::optional<Clutter> clutter_;  // unless raw
  SpeckleReduction reduction_;
  std::vector<float> smooth_;           // (n_lines, n_samples), unless nothing is smoothed
  std::vector<std::uint8_t> previous_;  // (height, width)
  bool has_previous_ = false;
};

}  // namespace artus
