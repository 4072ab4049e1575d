// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <span>
#include <vector>

#include "artus/echo/beam_shape.h"
#include "artus/echo/frame.h"
#include "artus/echo/needle_echo.h"
#include "artus/echo/placed_line.h"
#include "artus/echo/transducer.h"

namespace artus {

/// Something far smaller than the beam that drifts in a liquid: a bubble, a clump of grains.
struct DriftingPoint {
  Vec3 p_J = Vec3::Zero();  ///< m
  Vec3 v_J = Vec3::Zero();  ///< m/s; only colour Doppler looks at it
  double amplitude = 0;     ///< echo on the beam's axis, mirror = 1
  double phase = 0;         ///< rad, its own
  double tail = 0;          ///< m of ringing below it, which falls by 6 dB each half millimetre
};

/// The echoes of drifting points on the scanlines: each at its own time of flight with what the
/// tissue above leaves of it, and a phase of its own that turns with depth, so that crowded points
/// make a speckle that changes as they move.
class DriftingEcho {
 public:
  /// Requires: `shape` outlives this object.
  DriftingEcho(const Transducer& transducer, const BeamShape& shape) noexcept;

  /// The points as the probe at X_JP sees them. Cost: allocates only for more than ever before.
  void place(std::span<const DriftingPoint> points, const Pose& X_JP);

  /// Adds them to one scanline before the beam's shape is applied.
  void add(const SoundedLine& sounded, EchoSpan echoes) const noexcept;

  /// Colours what moves fast enough for the wall filter, where no bone or gas hides it: half a
  /// millimetre around each point, or the beam's width. `limit`: m/s at which velocities wrap
  /// round.
  void colour(std::span<const PlacedLine> lines, double limit, Frame& frame) const noexcept;

 private:
  struct Placed {
    Vec3 p_P;
    Vec3 v_P;
    double amplitude;
    double tail;
    double phase;  // rad
  };

  const BeamShape* shape_;
  double wavenumber_;  // rad/m of depth, both ways
  Pose X_PJ_ = Pose::Identity();
  std::vector<Placed> points_;
};

}  // namespace artus
