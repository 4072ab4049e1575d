// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <optional>

#include "artus/core/geometry.h"

namespace artus::kit {

/// A low-pass for poses whose corner frequency rises with the speed: rest is quiet, motion has
/// little lag, nothing is predicted. fc = slowest + beta * speed, for the place by the speed of
/// `point`, for the direction by its turn at that point's distance. Source [Casiez2012], with the
/// turn filtered along the shortest arc.
class PoseFilter {
 public:
  struct Params {
    double slowest = 1;       ///< Hz at rest
    double beta = 200;        ///< Hz per m/s: 0.2 per mm/s
    double speed_cutoff = 1;  ///< Hz, of the speed itself
    double arm = 0.1;         ///< m that turns a speed of turning into one of a place
  };
  explicit PoseFilter(const Params& params) : params_(params) {}

  /// `time` must rise, s. `point_B`: what is to be quiet (the tip), in the pose's own frame.
  [[nodiscard]] Pose take(double time, const Pose& X_AB, const Vec3& point_B);
  void forget() { last_.reset(); }

 private:
  struct Last {
    double time = 0;
    Vec3 raw = Vec3::Zero();
    Vec3 point = Vec3::Zero();
    Vec3 speed = Vec3::Zero();
    Eigen::Quaterniond raw_turn{1, 0, 0, 0};
    Eigen::Quaterniond turn{1, 0, 0, 0};
    double turning = 0;
  };
  Params params_;
  std::optional<Last> last_;
};

}  // namespace artus::kit
