// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/training/metrics/sight_course.h"

#include <algorithm>
#include <cmath>

namespace artus {

std::vector<std::optional<TipSight>> look_along(const Scene& scene, const TipSightFinder& finder,
                                                std::span<const TrackPoint> needle,
                                                std::span<const TrackPoint> probe) {
  std::vector<std::optional<TipSight>> sights(needle.size());
  std::size_t k = 0;
  for (std::size_t i = 0; i < needle.size(); ++i) {
    while (k + 1 < probe.size() && probe[k].time < needle[i].time - 0.5 / kTrackRate) ++k;
    if (k >= probe.size() || std::abs(probe[k].time - needle[i].time) > 1 / kTrackRate) continue;
    sights[i] = finder.look(scene, pose_of(probe[k]), pose_of(needle[i]));
  }
  return sights;
}

SightTotals sum_sight(std::span<const CoursePoint> course,
                      std::span<const std::optional<TipSight>> sights) {
  SightTotals sum;
  Run run;
  double coming = 0;  // m inside, and never yet between the picture's edges
  bool came = false;
  const auto close = [&] {
    if (run.amount >= kUnseenDistance) sum.unseen.push_back(run);
    run = {};
  };
  for (std::size_t i = 1; i < course.size(); ++i) {
    const CoursePoint& now = course[i];
    if (!now.inside() || !sights[i]) {
      close();
      continue;
    }
    const TipSight& sight = *sights[i];
    const double dt = now.time - course[i - 1].time;
    const double distance = std::max(0.0, now.advance);
    sum.time += dt;
    sum.advanced += distance;
    if (std::abs(sight.offset) <= sight.half_width && std::abs(sight.plane_angle) <= kInPlane)
      sum.advanced_in_plane += distance;
    sum.offsets.push_back(std::abs(sight.offset));
    sum.angles.push_back(std::abs(sight.plane_angle));
    if (sight.loss == SightLoss::off_sector && !came) {
      coming += distance;
    } else if (!came) {
      came = true;
      sum.outside_picture = coming;
    }
    if (sight.seen()) {
      sum.time_seen += dt;
      close();
      continue;
    }
    if (run.amount == 0) run.from = course[i - 1].time;
    run.to = now.time;
    run.amount += distance;
  }
  close();
  return sum;
}

std::optional<double> percentile(std::vector<double> values, double share) {
  if (values.empty()) return std::nullopt;
  const auto rank =
      static_cast<std::size_t>(std::clamp(std::ceil(share * static_cast<double>(values.size())) - 1,
                                          0.0, static_cast<double>(values.size() - 1)));
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(rank),
                   values.end());
  return values[rank];
}

}  // namespace artus
