// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include "artus/core/geometry.h"
#include "artus/detail/core/check.h"
#include "artus/detail/core/units.h"

namespace artus {

struct LineParams {
  double withdrawal = 5e-3;    ///< m drawn back at which the line gives way at `deviation`;
                               ///< assumed: above tremor, below the source's "few centimetres"
  double deviation = 0.15e-3;  ///< m off the line that it always bears; assumed: above tremor
  double angle = 1 * kDegree;  ///< rad off the line that it always bears; assumed
  double advance = 1e-3;  ///< m on a new line until it begins to hold; assumed: above what a hand
                          ///< that turns advances without meaning to
  double drag = 0.5e-3;   ///< m by which the tip drags the line until all but 1/e of the old
                          ///< track is lost; assumed: a needle's width
  double near_skin =
      3e-3;            ///< m, nearer the skin a line does not turn, as the direction from entry
                       ///< to tip is not defined well; it is let go on the way out; assumed
  double play = 1e-3;  ///< m that a needle which went in nearer the skin than that comes back
                       ///< before its line is let go; assumed: above tremor
};

/// What the line did in a tick.
struct LineChange {
  bool moved = false;
  double turned = 0;  ///< m, by which the tip dragged it, at the tip
  double gain = 0;    ///< m, by which it made the depth greater
  double kept = 1;    ///< share of the cut track in front of the tip that is still the tip's path
};

/// The line that tissue holds the shaft on: from the entry P0 along u. The tip may be off it by a
/// band without end while nothing is withdrawn, by max(deviation, angle * x) after `withdrawal`,
/// and by (withdrawal / withdrawn)^4 of that in between; a tip that goes beyond drags the line
/// after it, about the entry and inside the cone alpha(depth). A line that is dragged loses the old
/// track, and with it how far the needle was withdrawn, by exp(-path dragged / drag). So a line is
/// not taken or kept: it moves continuously with the path, as a loop of any rate finds it. On the
/// way out of the skin the line is let go in the same manner: by the share of the last millimetres
/// that is left it stays, and else it is the needle's own axis, as before a puncture. The tip is
/// never farther off it than it is deep, nor the needle's axis turned from it by more than 90
/// degrees at near_skin and less nearer. Frame J, m.
class InsertionLine {
 public:
  explicit InsertionLine(const LineParams& params, double needle_length) noexcept
      : params_(params), needle_length_(needle_length) {}

  /// A line through `tip` along `axis` (unit), on which the tip is `depth` m deep.
  /// `skin_normal`: of the skin at the entry; any that is not across the axis: as good as -axis.
  ARTUS_REALTIME void start(const Vec3& tip, const Vec3& axis, double depth,
                            const Vec3& skin_normal) noexcept;

  /// The tip moves straight to `tip`, the needle's own axis becomes `own_axis` (unit). The path is
  /// gone in parts of some micrometres, so that a slow loop's line goes as a fast one's.
  ARTUS_REALTIME LineChange follow(const Vec3& tip, const Vec3& own_axis) noexcept;

  [[nodiscard]] const Vec3& entry() const noexcept { return entry_; }
  [[nodiscard]] const Vec3& axis() const noexcept { return axis_; }
  [[nodiscard]] double depth(const Vec3& tip) const noexcept { return (tip - entry_).dot(axis_); }

 private:
  double band(double depth) const noexcept;
  void step(const Vec3& tip, const Vec3& own_axis, LineChange& change) noexcept;
  void approach(const Vec3& on_line, const Vec3& own_axis, double share) noexcept;
  void slide(const Vec3& tip, const Vec3& own_axis, LineChange& change) noexcept;
  void let_go(const Vec3& tip, const Vec3& own_axis, LineChange& change) noexcept;
  void turn(const Vec3& tip, LineChange& change) noexcept;
  Vec3 inside_cone(const Vec3& axis, double depth) const noexcept;

  LineParams params_;
  double needle_length_;
  Vec3 entry_ = Vec3::Zero();
  Vec3 axis_ = Vec3::UnitZ();
  Vec3 first_axis_ = Vec3::UnitZ();
  Vec3 skin_normal_ = -Vec3::UnitZ();
  Vec3 last_tip_ = Vec3::Zero();
  Vec3 last_own_axis_ = Vec3::UnitZ();
  double deepest_ = 0;     // m, from which withdrawal counts
  double shallowest_ = 0;  // m, within near_skin, since the tip was deeper
};

}  // namespace artus
