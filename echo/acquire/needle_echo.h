// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <span>

#include "artus/detail/echo/acquire/beam_shape.h"
#include "artus/detail/echo/acquire/propagation.h"
#include "artus/detail/echo/probe/placed_line.h"
#include "artus/echo/needle_view.h"
#include "artus/echo/transducer.h"

namespace artus {

/// A scanline with the sound that went along it: the trace and the path of its central beam.
struct SoundedLine {
  const PlacedLine& placed;
  const BeamTrace& trace;
  const BeamPath& path;
};

/// The echoes of a needle on the scanlines: the near wall of the shaft, the lines that ring between
/// its walls, the repeat against the probe's face, the tip, the side lobes beside its ends, and the
/// shadow below, whose edge blurs with depth as the aperture looks round the shaft.
class NeedleEcho {
 public:
  /// Requires: `shape` outlives this object.
  NeedleEcho(const NeedleView& needle, const Pose& X_JP, const Transducer& transducer,
             const BeamShape& shape, Look look) noexcept;

  /// The tip as one scanline shows it.
  struct Tip {
    double share = 0;     ///< 1 on this line .. 0 a line's distance beside it, or unseen
    double sample = 0;    ///< displayed
    double depth = 0;     ///< m along the beam
    double log_gain = 0;  ///< ln of the two-way amplitude there
  };
  [[nodiscard]] Tip find_tip(const SoundedLine& sounded) const noexcept;

  /// Adds the needle's echoes to one scanline before the beam's shape is applied. `tip` is
  /// find_tip's.
  void add(const SoundedLine& sounded, const Tip& tip, EchoSpan echoes) const noexcept;

  /// Adds scatterers of rms `amplitude` along the needle's axis, fixed in the body: its track.
  void add_track(double amplitude, const SoundedLine& sounded, EchoSpan echoes) const noexcept;

  /// Multiplies `light` (n_samples), the share of the sound that reaches each sample of a scanline
  /// and returns, by what the needle lets pass.
  void shade(const PlacedLine& placed, std::span<float> light) const noexcept;

 private:
  struct Place;
  struct Extent;
  [[nodiscard]] Place find_place(const SoundedLine& sounded) const noexcept;
  [[nodiscard]] Extent find_extent(const PlacedLine& placed) const noexcept;
  void add_shaft(const Place& place, double sample, double amplitude,
                 std::span<float> line) const noexcept;
  void add_tip(const Tip& tip, std::span<float> line) const noexcept;
  void add_side_lobe(const Place& place, const BeamTrace& trace,
                     std::span<float> line) const noexcept;
  [[nodiscard]] double elevation_share(double y, double z) const noexcept;
  [[nodiscard]] double reflectivity(double angle) const noexcept;
  void add_rings(double sample, double shaft, double angle, std::span<float> line) const noexcept;

  const BeamShape* shape_;
  NeedleShape needle_;
  bool on_screen_;  // as looks other than raw show it
  Pose X_PJ_;
  Vec3 p_PTip_;
  Vec3 axis_P_;         // unit, from tip to hub
  double pitch_;        // m between scanlines
  double pulse_sigma_;  // m, standard deviation of the pulse along depth
  double f_number_;
  double max_aperture_;  // m
  double phase_;         // rad per unit sine of tilt, see specular_phase
};

}  // namespace artus
