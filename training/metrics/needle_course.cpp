// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/training/metrics/needle_course.h"

#include <algorithm>
#include <cmath>

#include "artus/detail/core/units.h"
#include "artus/detail/training/metrics/closed_body.h"
#include "artus/detail/training/metrics/swept_area.h"

namespace artus {
namespace {

constexpr double kShallow = 0.2e-3;     // m, still at the shallowest
constexpr double kHeldAngle = kDegree;  // rad
constexpr double kHeldTime = 0.5;       // s

double angle_between(const Vec3& a, const Vec3& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

/// Whether the shaft has held its direction for kHeldTime.
class HeldDirection {
 public:
  bool add(double time, const Vec3& axis) {
    if (!axis_ || angle_between(*axis_, axis) > kHeldAngle) {
      axis_ = axis;
      since_ = time;
    }
    return time - since_ > kHeldTime - 1e-9;
  }
  void reset() { axis_.reset(); }

 private:
  std::optional<Vec3> axis_;
  double since_ = 0;  // s
};

double speed_at(std::span<const CoursePoint> course, std::size_t i) {
  const double dt = course[i].time - course[i - 1].time;
  return dt > 0 ? course[i].step / dt : 0;
}

}  // namespace

std::vector<CoursePoint> make_course(const Scene& scene, std::span<const TrackPoint> track) {
  std::vector<CoursePoint> course;
  course.reserve(track.size());
  for (const TrackPoint& point : track) {
    CoursePoint now;
    now.time = point.time;
    now.tip = point.p;
    now.axis = axis_of(point);
    now.region = region_of_tip(scene, now.tip, now.axis);
    if (now.inside()) {
      const auto entry = find_entry(scene, now.tip, now.axis);
      now.entry = entry.value_or(now.tip);
      now.depth = (now.tip - now.entry).norm();
    }
    if (!course.empty()) {
      const Vec3 moved = now.tip - course.back().tip;
      now.step = moved.norm();
      if (now.inside()) now.advance = moved.dot(now.axis);
    }
    course.push_back(now);
  }
  return course;
}

CourseTotals sum_course(std::span<const CoursePoint> course) {
  CourseTotals sum;
  for (std::size_t i = 0; i < course.size(); ++i) {
    const CoursePoint& now = course[i];
    sum.path += now.step;
    if (!now.inside()) continue;
    if (!sum.first_contact) {
      sum.first_contact = now.time;
      sum.entered = i > 0 ? course[i - 1].time : now.time;
    }
    sum.last_inside = now.time;
    sum.deepest = std::max(sum.deepest, now.depth);
    if (i == 0) continue;
    const CoursePoint& before = course[i - 1];
    sum.path_in_tissue += now.step;
    sum.time_in_tissue += now.time - before.time;
    sum.advanced += std::max(0.0, now.advance);
    if (before.inside())
      sum.swept_area += swept_area({before.tip, before.entry}, {now.tip, now.entry});
  }
  return sum;
}

std::vector<Run> find_idle(std::span<const CoursePoint> course, std::span<const TrackPoint> probe,
                           double speed, double longest) {
  std::size_t k = 1;
  const auto sweeps = [&](double time) {
    while (k + 1 < probe.size() && probe[k].time < time - 0.5 / kTrackRate) ++k;
    if (k >= probe.size() || std::abs(probe[k].time - time) > 1 / kTrackRate) return false;
    const TrackPoint& before = probe[k - 1];
    return (probe[k].p - before.p).norm() * kTrackRate >= speed ||
           before.q.angularDistance(probe[k].q) * kTrackRate >= kRestTurn;
  };
  std::vector<Run> runs;
  std::optional<double> since;
  const auto close = [&](double at) {
    if (since && at - *since > longest) runs.push_back({*since, at, at - *since});
    since.reset();
  };
  for (std::size_t i = 1; i < course.size(); ++i) {
    const bool still = course[i].inside() && speed_at(course, i) < speed && !sweeps(course[i].time);
    if (still && !since) since = course[i - 1].time;
    if (!still) close(course[i - 1].time);
  }
  if (!course.empty()) close(course.back().time);
  return runs;
}

std::vector<double> find_passes(std::span<const CoursePoint> course, double distance) {
  std::vector<double> starts;
  bool inward = true;
  double extreme = 0;       // m, deepest of this pass or shallowest since it
  double extreme_time = 0;  // s
  for (const CoursePoint& now : course) {
    if (starts.empty()) {
      if (!now.inside()) continue;
      starts.push_back(now.time);
      extreme = now.depth;
    }
    if (inward ? now.depth > extreme : now.depth < extreme + kShallow) {
      extreme = inward ? now.depth : std::min(extreme, now.depth);
      extreme_time = now.time;
    } else if (std::abs(now.depth - extreme) >= distance) {
      inward = !inward;
      if (inward) starts.push_back(extreme_time);
      extreme = now.depth;
      extreme_time = now.time;
    }
  }
  return starts;
}

std::vector<double> find_redirections(std::span<const CoursePoint> course, double angle,
                                      double distance) {
  std::vector<double> times;
  std::optional<Vec3> rest_axis;  // goes along with a turn that is counted until it is over
  HeldDirection held;
  bool turning = false;
  double deepest = 0;
  for (std::size_t i = 1; i < course.size(); ++i) {
    const CoursePoint& now = course[i];
    if (!now.inside()) {
      rest_axis.reset();
      held.reset();
      turning = false;
      deepest = 0;
      continue;
    }
    if (held.add(now.time, now.axis)) turning = false;
    deepest = std::max(deepest, now.depth);
    if (deepest - now.depth >= distance) {  // a pass begins anew
      rest_axis.reset();
      deepest = now.depth;
    }
    if (speed_at(course, i) >= kRestSpeed) continue;
    const bool turned = rest_axis && angle_between(*rest_axis, now.axis) > angle;
    if (turned && !turning) {
      times.push_back(now.time);
      turning = true;
    }
    if (!rest_axis || turned || turning) rest_axis = now.axis;
  }
  return times;
}

int count_movements(std::span<const double> speeds, double threshold, double hold) {
  const auto min = static_cast<std::ptrdiff_t>(std::ceil(hold * kTrackRate - 1e-9));
  int count = 0;
  std::ptrdiff_t fast = 0;
  std::ptrdiff_t slow = min;
  bool moving = false;
  for (const double speed : speeds) {
    if (speed > threshold) {
      ++fast;
      slow = 0;
      if (!moving && fast >= min) {
        moving = true;
        ++count;
      }
    } else {
      fast = 0;
      if (++slow >= min) moving = false;
    }
  }
  return count;
}

std::vector<double> speeds_of(std::span<const TrackPoint> track) {
  std::vector<double> speeds;
  for (std::size_t i = 1; i < track.size(); ++i)
    speeds.push_back((track[i].p - track[i - 1].p).norm() * kTrackRate);
  return speeds;
}

std::vector<double> turn_rates_of(std::span<const TrackPoint> track) {
  std::vector<double> rates;
  for (std::size_t i = 1; i < track.size(); ++i)
    rates.push_back(track[i - 1].q.angularDistance(track[i].q) * kTrackRate);
  return rates;
}

}  // namespace artus
