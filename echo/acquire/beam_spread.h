// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <vector>

#include "artus/detail/echo/acquire/propagation.h"
#include "artus/detail/echo/probe/placed_line.h"
#include "artus/echo/transducer.h"

namespace artus {

/// How far refraction drives neighbouring scanlines apart: their sound thins out between them,
/// which darkens what lies below the edges of curved structures. Both ways: the amplitude falls
/// with the distance between lines that a beam's width covers. Where lines draw together nothing is
/// gained (assumed: diffraction limits the focus). Source: conservation of energy in a tube of
/// rays.
class BeamSpread {
 public:
  /// `depth` (m) of `n_samples`. Requires: a valid transducer.
  BeamSpread(const Transducer& transducer, double depth, int n_samples);

  /// Notes the path of scanline `line`. Different lines may be noted by different threads.
  void note(int line, const BeamPath& path) noexcept;

  /// Weakens the samples of scanline `line`. Requires: every line has been noted.
  void apply(int line, EchoSpan echoes) const noexcept;

 private:
  static constexpr int kNodes = 17;

  [[nodiscard]] double gain(int line, int node) const noexcept;

  int n_lines_;
  int reach_;                           // lines to either side
  double pitch_;                        // m
  double curvature_;                    // 1/m, of the face
  double step_;                         // m between nodes
  std::size_t stride_;                  // samples between nodes
  std::vector<Eigen::Vector3f> place_;  // (n_lines, kNodes), frame J, m
  std::vector<char> bent_;              // (n_lines)
};

}  // namespace artus
