// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "artus/detail/echo/acquire/beam_shape.h"
#include "artus/detail/echo/acquire/beam_trace.h"
#include "artus/detail/echo/acquire/block_workers.h"
#include "artus/detail/echo/medium/region_acoustics.h"
#include "artus/detail/echo/probe/placed_line.h"
#include "artus/echo/frame.h"

namespace artus {

/// What colour Doppler finds in the body itself: blood in its vessels, and tissue that moves past
/// the face (a flash). A sample's velocity is the phase of the mean over beam and packet, as the
/// autocorrelation of echoes gives it [Kasai1985], so that it wraps round at the limit and blurs
/// over walls. Blood counts as far as it is heard: its power after time gain. What is slower than
/// the wall filter is left out.
class FlowDetector {
 public:
  /// Requires: `shape` outlives this object.
  FlowDetector(const Transducer& transducer, const ImageSettings& settings, const BeamShape& shape);

  /// A new frame at `time` (s); none: nothing is looked for. The tissue is compared with the frame
  /// before when that was less than half a second ago.
  void begin_frame(std::optional<double> time) noexcept;

  /// What the beam of scanline `l` met. `coupling`: 0..1. Lines may be noted by several threads.
  void note(int l, const BeamTrace& trace, std::span<const RegionAcoustics> regions,
            double coupling) noexcept;

  /// Adds what it found to velocity and motion_db of the frame, where nothing else moves. Cost:
  /// some 1 ms where blood runs or tissue moves.
  void colour(std::span<const float> time_gain, BlockWorkers& workers, Frame& frame) const;

 private:
  static constexpr std::size_t kNodes = 64;  // along a line, of how the tissue moves
  using RestRow = std::array<Vec3, kNodes>;  // m, frame J; not finite: no tissue

  void note_tissue(const BeamTrace& trace, RestRow& rest) const noexcept;
  void add_blood(const BeamTrace& trace, std::span<const BeamRun> runs, const Vessel& vessel,
                 double amplitude, EchoSpan blood) const noexcept;
  [[nodiscard]] bool tissue_velocity(std::size_t l,
                                     std::array<float, kNodes>& toward) const noexcept;
  void colour_line(int l, std::span<const float> time_gain, Frame& frame) const;

  const BeamShape* shape_;
  std::size_t n_lines_;
  std::size_t n_samples_;
  double speckle_;  // rms of muscle, mirror = 1
  double limit_;    // m/s
  std::optional<double> time_;
  std::optional<double> before_;
  std::vector<float> re_;  // (n_lines, n_samples), blood's power times its phase
  std::vector<float> im_;
  std::vector<char> has_blood_;  // (n_lines)
  std::vector<RestRow> rest_;    // (n_lines)
  std::vector<RestRow> rest_before_;
  std::vector<Vec3> direction_J_;  // (n_lines), unit
};

}  // namespace artus
