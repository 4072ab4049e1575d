// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <concepts>
#include <limits>
#include <span>

#include "artus/core/geometry.h"
#include "artus/detail/core/check.h"
#include "artus/detail/haptics/needle/laws/layer_haptics.h"
#include "artus/detail/haptics/wrench.h"

namespace artus {

/// A stretch of the insertion line in one region. Depths along the line, 0 at the skin entry.
struct ShaftLayer {
  double entry = 0;  ///< m
  double exit = 0;   ///< m
  RegionId region = kOutside;
};

/// Which direction the needle moves in along its line, by position alone (see MotionDetector).
enum class Motion { still, inward, outward };

/// All that a force law may look at in one tick. Frame J, SI.
struct NeedleTick {
  double dt = 1e-3;  ///< s, fixed: the period of the loop
  Vec3 tip = Vec3::Zero();
  Vec3 entry = Vec3::Zero();  ///< P0, where the line starts on the skin
  Vec3 axis = Vec3::UnitZ();  ///< u, unit, into the body
  double depth = 0;           ///< x = (tip - entry).axis, m
  double line_gain = 0;       ///< m, by which a line that moved in this tick made x greater
  double line_kept = 1;       ///< share of the cut track before the tip that it kept
  double velocity = 0;        ///< axial estimate, m/s, positive inward
  double incoming_speed = 0;  ///< axial speed over the last window before contact, m/s, >= 0
  Vec3 angular_velocity = Vec3::Zero();                               ///< rad/s
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();    ///< q_c
  Eigen::Quaterniond orientation_0 = Eigen::Quaterniond::Identity();  ///< q_0, when line stored
  double stillness = 0;  ///< 1 at rest, 0 on the move (see MotionDetector)
  double pushed = 0;     ///< m the tissue at the tip is pushed in; in what the laws see `depth` and
                         ///< `tip` are the hand's, so much deeper than the tip is in the material
  Vec3 surface_normal = -Vec3::UnitZ();  ///< of the skin where the needle crosses it, outward
  double dimple = 0;                     ///< m a membrane that still holds is pushed in; 0: none
  LayerHaptics membrane;                 ///< the layer behind that membrane
  double torn = 0;         ///< N, what a membrane that gives way in this tick held; 0: none
  double torn_dimple = 0;  ///< m it was pushed in
  double gave_way = 0;     ///< m, depth at which the skin did, in the tick of its puncture
  LayerHaptics layer;      ///< the soft layer the tip is cutting
  double bone_depth = std::numeric_limits<double>::infinity();  ///< m, where a hard layer begins
  LayerHaptics bone;
  std::span<const ShaftLayer> shaft;  ///< the layers from the skin to the tip
  const LayerTable* table = nullptr;
  double needle_length = 0.035;  ///< m

  /// Sum over the layers that the shaft is in of value(layer) * length, up to the tip. What the
  /// tissue is pushed in is a longer path through the layer at the tip: the hand's depth in all.
  template <class F>
  [[nodiscard]] double sum_over_shaft(F value) const noexcept {
    double sum = 0;
    const double tip_depth = depth - pushed;
    for (const ShaftLayer& s : shaft) {
      const double from = s.entry > 0 ? s.entry : 0;
      const double to = s.exit < tip_depth ? s.exit : tip_depth;
      if (!(to > from)) continue;
      const double length = to - from + (s.exit > tip_depth ? pushed : 0);
      sum += value((*table)[s.region].tissue) * (length > 0 ? length : 0);
    }
    return sum;
  }
};

/// A force law of the needle. Laws have their own small files; all take the same tick and return
/// what the hand feels, so that any mix of them can be summed and traced apart. Sign: a force along
/// +axis pulls the hand into the body; a force against insertion is along -axis.
template <class Law>
concept ForceModel = requires(Law& law, const NeedleTick& tick, double depth) {
  /// Forgets the past; the needle is at `depth` on a new line and feels nothing yet.
  { law.reset(depth) }
  noexcept;
  /// Advances by one tick and returns the wrench on the hand. Any finite tick gives a finite one.
  { law.step(tick) }
  noexcept->std::same_as<Wrench>;
};

}  // namespace artus
