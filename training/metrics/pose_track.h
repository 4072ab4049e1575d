// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstddef>
#include <vector>

#include "artus/core/geometry.h"
#include "artus/detail/core/check.h"
#include "artus/detail/training/metrics/metric.h"

namespace artus {

/// A pose at an even step of time.
struct TrackPoint {
  double time = 0;        ///< s
  Vec3 p = Vec3::Zero();  ///< m, frame J
  Eigen::Quaterniond q{1, 0, 0, 0};
};
[[nodiscard]] inline Vec3 axis_of(const TrackPoint& point) {
  return point.q * Vec3::UnitZ();
}
[[nodiscard]] Pose pose_of(const TrackPoint& point);

/// What every motion metric says of its poses: see PoseSampler and smooth.
[[nodiscard]] MetricRule motion_rule();
inline constexpr double kTrackRate = 20;  ///< Hz, of smooth()'s points

/// Takes poses as they come, at any rate and unevenly, to an even 100 Hz: the path is taken as
/// straight (and evenly turning) between neighbours, and each value is its mean over the 10 ms
/// around its instant; at both ends, where that is not covered, the path itself. Poses of one
/// instant count as a jump. A gap is crossed straight. Memory is taken at the start, so that poses
/// may come in the tick.
class PoseSampler {
 public:
  static constexpr double kRate = 100;  ///< Hz

  /// `longest`: s that will be kept; what comes later is left out (full()).
  explicit PoseSampler(double longest);

  /// Times must not fall. Cost: constant.
  ARTUS_REALTIME void add(double time, const Vec3& p, const Eigen::Quaterniond& q) noexcept;
  [[nodiscard]] bool full() const noexcept { return full_; }
  [[nodiscard]] bool empty() const noexcept { return !started_; }

  /// The points so far; from any one thread while nobody adds.
  [[nodiscard]] std::vector<TrackPoint> points() const;

 private:
  using Value = Eigen::Matrix<double, 7, 1>;  // position, then quaternion x, y, z, w
  void cross(double from, double to, const Value& a, const Value& b) noexcept;
  void close_cell() noexcept;

  std::vector<Value> values_;  // (n), one a cell; never grows beyond what was reserved
  Value last_ = Value::Zero();
  Value sum_ = Value::Zero();  // over the open cell
  Value centre_ = Value::Zero();
  double weight_ = 0;  // s covered of the open cell
  bool has_centre_ = false;
  double start_ = 0;  // s
  double last_time_ = 0;
  bool started_ = false;
  bool full_ = false;
};

/// The points at 20 Hz after a Butterworth low-pass of second order at 6 Hz, forward and backward.
/// Removes tremor and the sensor's noise: noise of sigma an axis makes a resting point walk
/// 2.257 sigma at each step, 22.6 mm/s for 10 um at 1 kHz. Requires: points 10 ms apart.
[[nodiscard]] std::vector<TrackPoint> smooth(const std::vector<TrackPoint>& points);

}  // namespace artus
