// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <optional>
#include <span>
#include <vector>

#include "artus/detail/training/metrics/pose_track.h"
#include "artus/raycast/scene.h"

namespace artus {

/// m/s below which a tip is at rest; assumed.
inline constexpr double kRestSpeed = 2e-3;
/// rad/s below which a probe is at rest: 2 degrees; assumed.
inline constexpr double kRestTurn = 0.034906585039886591;

/// Where the needle is at an even step of time, in the body as it rests.
struct CoursePoint {
  double time = 0;             ///< s
  Vec3 tip = Vec3::Zero();     ///< m, frame J
  Vec3 axis = Vec3::UnitZ();   ///< unit, hub to tip
  Vec3 entry = Vec3::Zero();   ///< m, on the skin; meaningless outside
  RegionId region = kOutside;  ///< at the tip
  double depth = 0;            ///< m from entry to tip along the needle; 0 outside
  double step = 0;             ///< m moved since the point before
  double advance = 0;          ///< m of it along the needle, inside at its end; negative: withdrawn
  [[nodiscard]] bool inside() const noexcept { return region != kOutside; }
};

/// The course of a track through a body. Cost: two queries a point.
[[nodiscard]] std::vector<CoursePoint> make_course(const Scene& scene,
                                                   std::span<const TrackPoint> track);

/// Totals of a course, SI.
struct CourseTotals {
  double path = 0;                      ///< m, sum of steps
  double path_in_tissue = 0;            ///< m, steps that end inside
  double time_in_tissue = 0;            ///< s, intervals that end inside
  double swept_area = 0;                ///< m^2, both ends inside
  double advanced = 0;                  ///< m forward along the needle inside
  std::optional<double> entered;        ///< s, begin of the first interval that ends inside
  std::optional<double> first_contact;  ///< s, the first point inside
  std::optional<double> last_inside;    ///< s
  double deepest = 0;                   ///< m
};
[[nodiscard]] CourseTotals sum_course(std::span<const CoursePoint> course);

/// A stretch of time in which something held.
struct Run {
  double from = 0;    ///< s
  double to = 0;      ///< s
  double amount = 0;  ///< of whatever was summed over it
};

/// Stretches inside the body, longer than `longest` s, in which the tip goes slower than `speed`
/// m/s, and so does the probe, which turns slower than kRestTurn, too: who sweeps is not idle.
/// `probe`: on the same steps; empty: there is none.
[[nodiscard]] std::vector<Run> find_idle(std::span<const CoursePoint> course,
                                         std::span<const TrackPoint> probe = {},
                                         double speed = kRestSpeed, double longest = 3);

/// When each pass of the needle began: the first advance inside, and every advance of at least
/// `distance` m that follows a withdrawal of at least `distance`, dated when the needle was last
/// within 0.2 mm of its shallowest before it.
[[nodiscard]] std::vector<double> find_passes(std::span<const CoursePoint> course,
                                              double distance = 5e-3);

/// When the shaft had turned inside the body by more than `angle` rad between two rests (slower
/// than 2 mm/s), without a withdrawal of `distance` m between them. One turn counts once: the next
/// can begin when the shaft has held its direction within 1 degree for half a second.
[[nodiscard]] std::vector<double> find_redirections(std::span<const CoursePoint> course,
                                                    double angle = 0.08726646259971647,
                                                    double distance = 5e-3);

/// Runs faster than `threshold` that last `hold` s, closed after `hold` s below. `speeds`: even
/// steps of 1 / kTrackRate. Source [Weinstein2023] for 50 mm/s, 50 deg/s and 0.2 s.
[[nodiscard]] int count_movements(std::span<const double> speeds, double threshold, double hold);

/// m/s and rad/s between neighbouring points of a track; one fewer than points.
[[nodiscard]] std::vector<double> speeds_of(std::span<const TrackPoint> track);
[[nodiscard]] std::vector<double> turn_rates_of(std::span<const TrackPoint> track);

}  // namespace artus
