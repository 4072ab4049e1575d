// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "artus/detail/echo/acquire/beam_shape.h"
#include "artus/detail/echo/acquire/needle_echo.h"
#include "artus/detail/echo/probe/placed_line.h"
#include "artus/echo/frame.h"
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

  /// The points as `probe` at X_JP sees them. Cost: some 0.2 us a point; allocates only for more
  /// than ever before.
  void place(std::span<const DriftingPoint> points, const Pose& X_JP, const Transducer& probe);

  /// Adds them to one scanline of that probe before the beam's shape is applied.
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

  struct LineRange {
    std::uint32_t first;
    std::uint32_t end;
  };
  [[nodiscard]] static LineRange lines_beside(const Vec3& p_P, const Transducer& probe) noexcept;
  void sort_by_line(const Transducer& probe);

  const BeamShape* shape_;
  double wavenumber_;  // rad/m of depth, both ways
  Pose X_PJ_ = Pose::Identity();
  std::vector<Placed> points_;
  std::vector<LineRange> ranges_;       // (points) lines that may show them
  std::vector<std::uint32_t> at_line_;  // points, line by line, ascending
  std::vector<std::uint32_t> begin_;    // (lines + 1) of each line's in at_line_
};

}  // namespace artus
