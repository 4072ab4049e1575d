// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/training/metrics/placement.h"

#include <algorithm>
#include <cmath>

namespace artus {
namespace {

constexpr double kWindow = 0.5;       // s
constexpr double kDrift = 0.5e-3;     // m/s
constexpr double kAround = 0.75e-3;   // m
constexpr double kWithdrawn = 5e-3;   // m, as a pass's
constexpr double kForward = 1e-3;     // m
constexpr double kPause = 5;          // s, shorter than a stay on the way out
constexpr double kInjected = 0.1e-6;  // m^3

Vec3 mean_tip(std::span<const CoursePoint> points) {
  Vec3 sum = Vec3::Zero();
  for (const CoursePoint& point : points) sum += point.tip;
  return sum / static_cast<double>(points.size());
}

/// Whether a window of kWindow is at rest.
bool rests(std::span<const CoursePoint> window) {
  const std::size_t half = window.size() / 2;
  if (half == 0) return false;
  const Vec3 drift = mean_tip(window.last(half)) - mean_tip(window.first(half));
  if (drift.norm() > kDrift * kWindow / 2) return false;
  const Vec3 mean = mean_tip(window);
  return std::all_of(window.begin(), window.end(), [&](const CoursePoint& point) {
    return point.inside() && (point.tip - mean).norm() <= kAround;
  });
}

/// For each point whether the needle has been withdrawn and goes on doing so.
std::vector<bool> find_way_out(std::span<const CoursePoint> course) {
  std::vector<double> after(course.size());  // m, deepest from here on
  double deepest = 0;
  for (std::size_t i = course.size(); i-- > 0;) {
    deepest = std::max(deepest, course[i].depth);
    after[i] = deepest;
  }
  std::vector<bool> out(course.size());
  double before = 0;   // m, deepest since the needle last went forward
  double shallow = 0;  // m, shallowest since then
  for (std::size_t i = 0; i < course.size(); ++i) {
    shallow = std::min(shallow, course[i].depth);
    if (course[i].depth > std::min(before, shallow + kForward)) before = shallow = course[i].depth;
    out[i] = course[i].depth <= before - kWithdrawn && after[i] <= course[i].depth + kForward;
  }
  return out;
}

std::optional<std::size_t> find_injection(std::span<const CoursePoint> course,
                                          std::span<const Dose> doses) {
  double all = 0;
  for (const Dose& dose : doses) all += dose.volume;
  if (all < kInjected) return std::nullopt;
  double given = 0;
  double time = 0;
  for (const Dose& dose : doses) {
    given += dose.volume;
    time = dose.time;
    if (given >= all / 2) break;
  }
  const auto at = std::lower_bound(course.begin(), course.end(), time,
                                   [](const CoursePoint& p, double t) { return p.time < t; });
  if (at == course.end() || !at->inside()) return std::nullopt;
  return static_cast<std::size_t>(at - course.begin());
}

double length_of(std::span<const CoursePoint> course, const Stay& stay) {
  return course[stay.last].time - course[stay.first].time;
}

}  // namespace

std::vector<Stay> find_stays(std::span<const CoursePoint> course) {
  const std::vector<bool> way_out = find_way_out(course);
  std::vector<Stay> stays;
  const auto n = static_cast<std::size_t>(std::lround(kWindow * kTrackRate)) + 1;
  for (std::size_t i = 0; i + n <= course.size(); ++i) {
    if (!rests(course.subspan(i, n))) continue;
    const std::size_t last = i + n - 1;
    const bool goes_on = !stays.empty() && i <= stays.back().last &&
                         (course[last].tip - course[stays.back().first].tip).norm() <= kAround;
    if (goes_on)
      stays.back().last = last;
    else if (stays.empty() || i > stays.back().last)
      stays.push_back({i, last, false});
  }
  for (Stay& stay : stays) stay.on_way_out = way_out[(stay.first + stay.last) / 2];
  return stays;
}

std::optional<std::size_t> find_placement(std::span<const CoursePoint> course, const Target* target,
                                          std::span<const Dose> doses) {
  if (const auto injected = find_injection(course, doses)) return injected;
  std::optional<std::size_t> best;
  double least = 0;  // m to the target, or minus s of the stay
  for (const Stay& stay : find_stays(course)) {
    const double length = length_of(course, stay);
    if (stay.on_way_out && length < kPause) continue;
    const std::size_t middle = (stay.first + stay.last) / 2;
    const double worth = target != nullptr ? distance_to(*target, course[middle].tip) : -length;
    if (best && worth >= least) continue;
    best = middle;
    least = worth;
  }
  if (best) return best;
  for (std::size_t i = 0; i < course.size(); ++i)
    if (course[i].inside() && (!best || course[i].depth > course[*best].depth)) best = i;
  return best;
}

}  // namespace artus
