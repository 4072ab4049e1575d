// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <vector>

#include "artus/detail/echo/acquire/beam_trace.h"
#include "artus/detail/echo/probe/placed_line.h"
#include "artus/echo/transducer.h"

namespace artus {

/// What the rest of the aperture sees where a steep or bending interface takes the sound from one
/// line's own ray: an echo is heard by the whole aperture that serves its depth, and a narrow
/// obstacle hides a part of that alone. Below the edge of a tendon or a fascia a line is therefore
/// as loud as the mean of the lines that its aperture spans: a strip that is dimmed and fades with
/// depth, not a black band. For looks other than raw, in which nobody measures single rays.
class ApertureLight {
 public:
  /// `depth` (m) of `n_samples`. Requires: a valid transducer.
  ApertureLight(const Transducer& transducer, double depth, int n_samples);

  /// Notes what the central beam of scanline `line` loses. Different lines may be noted by
  /// different threads.
  void note(int line, const BeamTrace& trace) noexcept;

  /// Raises the samples of scanline `line`. Requires: every line has been noted.
  void apply(int line, EchoSpan echoes) const noexcept;

 private:
  static constexpr int kNodes = 17;

  [[nodiscard]] double gain(int line, int node) const noexcept;

  int n_lines_;
  double pitch_;  // m
  double f_number_;
  double max_aperture_;  // m
  double step_;          // m between nodes
  std::size_t stride_;   // samples between nodes
  std::vector<float>
      arrives_;  // (n_lines, kNodes), two-way amplitude; negative: the line has ended
};

}  // namespace artus
