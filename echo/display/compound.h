// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <span>
#include <vector>

#include "artus/detail/echo/acquire/block_workers.h"
#include "artus/echo/image_settings.h"
#include "artus/echo/transducer.h"

namespace artus {

/// One of the steered frames of a compound image, and how it lies over the probe's own scanlines.
class CompoundView {
 public:
  /// `offset`: rad, added to the probe's steering. Requires: a linear probe.
  CompoundView(const Transducer& transducer, const ImageSettings& settings, double offset);

  /// The probe that makes the steered frame.
  [[nodiscard]] const Transducer& transducer() const noexcept { return transducer_; }

  /// Adds this view's share to scanline `l` of the probe: `envelope` is the steered frame's
  /// (n_lines, n_samples); `weight` counts the views that cover each sample.
  void add(std::span<const float> envelope, int l, std::span<float> sum,
           std::span<float> weight) const noexcept;

 private:
  struct Place {
    float line = 0;    // lines beside the probe's own
    float sample = 0;  // of the steered line
  };
  Transducer transducer_;
  std::vector<Place> places_;  // (n_samples)
};

/// The mean envelope of several steered frames.
class CompoundMean {
 public:
  /// Requires: valid transducer and settings.
  CompoundMean(const Transducer& transducer, const ImageSettings& settings);

  /// The steered frames to make, the unsteered one last; none when nothing is compounded.
  [[nodiscard]] std::span<const CompoundView> views() const noexcept { return views_; }

  void clear() noexcept;
  void add(const CompoundView& view, std::span<const float> envelope, BlockWorkers& workers);
  /// Writes the mean; zero where no view reaches.
  void write(std::span<float> envelope) const noexcept;

 private:
  std::size_t n_samples_;
  int n_lines_;
  std::vector<CompoundView> views_;
  std::vector<float> sum_;     // (n_lines, n_samples)
  std::vector<float> weight_;  // the same
};

}  // namespace artus
