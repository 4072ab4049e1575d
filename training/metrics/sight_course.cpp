// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/training/metrics/sight_course.h"

#include <algorithm>
#include <cmath>
#include <utility>

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

void look_at_pictures(std::span<const CoursePoint> course, std::span<const ImageSight> images,
                      std::span<std::optional<TipSight>> sights) {
  std::size_t first = 0;
  for (std::size_t i = 0; i < course.size(); ++i) {
    while (first < images.size() && images[first].time < course[i].time - kGlance) ++first;
    std::vector<double> contrasts;
    for (std::size_t k = first; k < images.size() && images[k].time <= course[i].time + kGlance;
         ++k)
      contrasts.push_back(images[k].contrast_db.value_or(kNotShown));
    if (sights[i]) sights[i]->shown_db = percentile(std::move(contrasts), 0.5);
  }
}

namespace {

/// Runs that are advanced unseen, and how many advances they are.
class UnseenRuns {
 public:
  explicit UnseenRuns(SightTotals& sum) : sum_(sum) {}

  void close() {
    if (run_.amount >= kUnseenDistance) {
      sum_.unseen.push_back(run_);
      const double beyond = run_.amount - entry_;
      sum_.unseen_advances += 1 + std::max(0, static_cast<int>(beyond / kBlind));
    }
    run_ = {};
    entry_ = 0;
    at_ = front_ = 0;
  }
  /// `moved`: m along the needle from one instant to the other. `entering`: before the picture's
  /// edge. Only what goes beyond where the run has been counts, so that tremor is no advance.
  void go(double from, double to, double moved, bool entering) {
    if (run_.amount > 0 && to - run_.to > kUnseenRest) close();
    at_ += moved;
    front_ = std::min(front_, at_ + kWithdrawn);
    const double distance = at_ - front_;
    if (distance <= 0) return;
    front_ = at_;
    if (run_.amount == 0) run_.from = from;
    run_.to = to;
    run_.amount += distance;
    if (entering) entry_ += distance;
  }

 private:
  SightTotals& sum_;
  Run run_;
  double entry_ = 0;                          // m of the run
  double at_ = 0;                             // m along the needle since the run began
  double front_ = 0;                          // m, the farthest of it
  static constexpr double kWithdrawn = 1e-3;  // m, after which it may advance anew
};

/// When the tip first came between the picture's edges; the end when it never did.
std::size_t find_coming(std::span<const CoursePoint> course,
                        std::span<const std::optional<TipSight>> sights) {
  std::size_t i = 1;
  while (i < course.size() && (!course[i].inside() || !sights[i] || !sights[i]->in_picture)) ++i;
  return i;
}

}  // namespace

SightTotals sum_sight(std::span<const CoursePoint> course,
                      std::span<const std::optional<TipSight>> sights) {
  SightTotals sum;
  UnseenRuns unseen(sum);
  const std::size_t coming = find_coming(course, sights);
  const bool came = coming < course.size();
  for (std::size_t i = 1; i < course.size(); ++i) {
    const CoursePoint& now = course[i];
    if (!now.inside() || !sights[i]) {
      unseen.close();
      continue;
    }
    const TipSight& sight = *sights[i];
    const double before = course[i - 1].time;
    const double distance = std::max(0.0, now.advance);
    sum.time += now.time - before;
    sum.advanced += distance;
    if (std::abs(sight.offset) <= sight.half_width && std::abs(sight.plane_angle) <= kInPlane)
      sum.advanced_in_plane += distance;
    sum.offsets.push_back(std::abs(sight.offset));
    sum.angles.push_back(std::abs(sight.plane_angle));
    if (came && i < coming) sum.outside_picture += distance;
    if (sight.seen()) {
      sum.time_seen += now.time - before;
      unseen.close();
    } else {
      unseen.go(before, now.time, now.advance, came && i < coming);
    }
  }
  unseen.close();
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
