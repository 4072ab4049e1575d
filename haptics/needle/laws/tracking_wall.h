// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include "artus/detail/haptics/needle/laws/force_model.h"

namespace artus {

struct TrackingWallParams {
  double settling_time = 0.2;  ///< s, T_s, wall onto tip after a stop; assumed: the source tunes n
  double moving_time = 0.075;  ///< s on the move after which a stop takes all of T_s again; assumed
  double fall_time = 3e-3;     ///< s, time constant of f_R and f_A where a weaker layer begins;
                               ///< assumed: the time in which a membrane tears
};

/// The tracking wall: a spring whose anchor `w` follows the tip at the distance D = f_R / K_t, so
/// that the force never exceeds the layer's cutting force and the needle stays where it stops.
/// One anchor serves both directions: w in [x - D, x + D_a], D_a = f_A / K_t, resists withdrawal.
/// The deepest anchor is the cut front: in front of it tissue is cut, behind it the track is open
/// and only withdrawal is resisted. A hard layer cannot be cut: past its surface a spring adds to
/// the soft force, up to the hard layer's f_R, and relaxes neither by stops nor by cutting.
/// Where a weaker layer begins the force falls within milliseconds, not between two ticks, so that
/// a loop that finds the layer a period later renders nearly the same. A needle that is still in
/// part settles at that share of the pace (NeedleTick::stillness): a hand that yields to the fading
/// force slows the fading down and creeps into its rest without jerks. The energy given back is
/// never more than what was taken since reset, whatever the layers, their stiffness or the sampling
/// do: on the way back the force is bounded by the account. Depths are the hand's: K_t was measured
/// there, with all that gives way before the tip in it. Source [Alamilla2020] eqs. 2.14-2.19;
/// (2.14) w = x - D (printed D - x), (2.16) a straight line, n ticks written as a settling time,
/// eps as a band of speeds.
class TrackingWall {
 public:
  explicit TrackingWall(const TrackingWallParams& params = {}) noexcept : params_(params) {}
  ARTUS_REALTIME void reset(double depth) noexcept;
  ARTUS_REALTIME Wrench step(const NeedleTick& tick) noexcept;

  /// Starts an insertion at the skin: nothing is cut, the wall is at `w0`, the tip at `depth`.
  ARTUS_REALTIME void start(double w0, double depth) noexcept;

  /// The line moved where the needle is: depths are `by` m more, what is felt stays, and of the cut
  /// track in front of the tip the share `kept` is left.
  ARTUS_REALTIME void take_line(double by, double kept) noexcept;

  [[nodiscard]] double wall() const noexcept { return wall_; }        ///< w, m
  [[nodiscard]] double cut_front() const noexcept { return cut_; }    ///< deepest w, m
  [[nodiscard]] double absorbed() const noexcept { return energy_; }  ///< J taken from the hand

 private:
  double soft_force(const NeedleTick& tick, double x) noexcept;
  void settle(const NeedleTick& tick, double x) noexcept;
  void follow_limits(const NeedleTick& tick) noexcept;

  TrackingWallParams params_;
  double wall_ = 0;
  double cut_ = 0;
  double stiffness_ = 0;        // of the layer the anchor was placed with
  double cutting_limit_ = 0;    // N, f_R on its way to that of a weaker layer
  double attracted_limit_ = 0;  // N, f_A likewise
  double settle_left_ = 0;      // s
  double last_x_ = 0;
  double last_force_ = 0;
  double energy_ = 0;
};

}  // namespace artus
