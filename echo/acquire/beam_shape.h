// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "artus/detail/echo/medium/scatter_field.h"
#include "artus/detail/echo/probe/beam_profile.h"
#include "artus/echo/image_settings.h"
#include "artus/echo/transducer.h"

namespace artus {

/// The point spread of one transducer sampled for one image: pulse along the line, a Gaussian of
/// depth-dependent width across lines, weights of the elevation planes. All echoes are baseband
/// (in phase and quadrature), so the pulse is its envelope.
class BeamShape {
 public:
  /// Requires: valid transducer and settings. Cost: about 0.1 s, for the elevation profile.
  BeamShape(const Transducer& transducer, const ImageSettings& settings);

  [[nodiscard]] const BeamProfile& profile() const noexcept { return profile_; }
  [[nodiscard]] int n_samples() const noexcept { return n_samples_; }
  [[nodiscard]] double sample_depth() const noexcept { return sample_depth_; }

  /// What this beam sees as one scatterer: half the pulse along the line, a line's pitch or more
  /// across, the slice at its thinnest.
  [[nodiscard]] const ScattererSize& scatterer_size() const noexcept { return scatterer_; }

  /// Elevation of plane `p` in units of the slice's width at each depth, -1..1.
  [[nodiscard]] double plane_offset(int p) const noexcept {
    return offsets_[static_cast<std::size_t>(p)];
  }
  /// Elevation (m) of plane `p` at beam depth `z`: the planes follow the beam's waist in straight
  /// pieces between the face, the focus and the end.
  [[nodiscard]] double plane_elevation(int p, double z) const noexcept;
  /// Whether scatterers are heard in plane `p`: of five planes and more in every second one, the
  /// middle among them. Those between lie closer to both neighbours than scatterers are large, so
  /// that they would hear nearly the same ones again; interfaces are heard in all. In the raw look
  /// all planes hear them: of three, speckle is a little more even than Rayleigh's.
  [[nodiscard]] bool hears_speckle(int p) const noexcept {
    const int planes = static_cast<int>(offsets_.size());
    return is_raw_ || planes < kAllHear || planes % 2 == 0 || p % 2 == planes / 2 % 2;
  }
  /// Beam lengths where the planes bend, m, ascending: face, focus, the longest path.
  [[nodiscard]] std::span<const double> plane_nodes() const noexcept { return nodes_; }

  /// Share of plane `p` in an echo that all planes see alike; the shares sum to one at each sample.
  [[nodiscard]] std::span<const float> echo_weight(int p) const noexcept;
  /// Weight of plane `p` on unit-power scatterers such that the sum over planes, after across() and
  /// along(), has unit power. Up to 8 floats behind the span may be read.
  [[nodiscard]] std::span<const float> speckle_weight(int p) const noexcept;

  /// Lines to either side that across() reaches.
  [[nodiscard]] int reach() const noexcept { return reach_; }
  /// Amplitude at `offset` (m) beside a scanline's axis of what one line of unit share receives.
  [[nodiscard]] double lateral_amplitude(double offset, double z) const noexcept;

  /// Distance between neighbouring scanlines at depth `z`, m.
  [[nodiscard]] double line_spacing(double z) const noexcept {
    return pitch_ * (1 + curvature_ * z);
  }
  /// What across() leaves of an echo that one line alone carries, at its own place and sample.
  [[nodiscard]] double line_share(double sample) const noexcept {
    const auto last = static_cast<double>(n_samples_ - 1);
    return kernel_[static_cast<std::size_t>(std::clamp(sample, 0.0, last))];
  }

  /// Spreads lines sideways: out = sum over k of kernel(|k|, sample) * lines[l + k]. `lines` is
  /// (n_lines, n_samples); lines beyond the edges count as silent.
  void across(std::span<const float> lines, int n_lines, int line,
              std::span<float> out) const noexcept;
  /// Convolves one line with the pulse. Requires: in and out do not overlap, n_samples each.
  void along(std::span<const float> in, std::span<float> out) const noexcept;

 private:
  static constexpr int kAllHear = 5;  // planes from which on only some hear scatterers
  void size_scatterers(const Transducer& transducer);
  [[nodiscard]] double heard_weight(int p, std::span<const double> weight) const noexcept;
  void tabulate_planes(const ImageSettings& settings);
  void tabulate_lateral(int n_lines);
  void tabulate_pulse(const Transducer& transducer);

  BeamProfile profile_;
  bool is_raw_;
  int n_samples_;
  double sample_depth_;  // m
  double pitch_;         // m between scanlines at the face
  double curvature_;     // 1/m, of the face
  ScattererSize scatterer_;
  std::vector<double> offsets_;        // (n_planes)
  std::vector<double> nodes_;          // (3) m
  std::vector<double> node_width_;     // (3) m
  std::vector<float> echo_weight_;     // (n_planes, n_samples)
  std::vector<float> speckle_weight_;  // (n_planes, n_samples)
  int reach_ = 0;
  std::vector<float> kernel_;  // (reach + 1, n_samples)
  std::vector<float> pulse_;   // (odd), peak 1
};

}  // namespace artus
