// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/evidence/validation/needle/analytic_body.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace artus {

AnalyticBody AnalyticBody::make_stack(const Vec3& origin, const Vec3& into,
                                      std::vector<double> begins) {
  ARTUS_REQUIRE(std::is_sorted(begins.begin(), begins.end()), "layers must follow one another");
  return {false, origin, into.normalized(), std::move(begins)};
}

AnalyticBody AnalyticBody::make_balls(const Vec3& centre, std::vector<double> radii) {
  ARTUS_REQUIRE(std::is_sorted(radii.rbegin(), radii.rend()), "balls must lie in one another");
  return {true, centre, Vec3::UnitZ(), std::move(radii)};
}

// The part of the segment inside the convex body of a layer; empty when to <= from.
AnalyticBody::Span AnalyticBody::clip(std::size_t layer, const Vec3& start, const Vec3& direction,
                                      double length) const noexcept {
  const Vec3 p = start - origin_;
  if (balls_) {
    const double b = p.dot(direction);
    const double root = b * b - p.squaredNorm() + sizes_[layer] * sizes_[layer];
    if (root <= 0) return {};
    return {std::max(0.0, -b - std::sqrt(root)), std::min(length, -b + std::sqrt(root))};
  }
  const double slope = direction.dot(into_);
  const double ahead = sizes_[layer] - p.dot(into_);
  if (slope == 0) return ahead <= 0 ? Span{0, length} : Span{};
  const double at = ahead / slope;
  return slope > 0 ? Span{std::max(0.0, at), length} : Span{0, std::min(length, at)};
}

QueryCount AnalyticBody::find_intervals(const Segment& segment,
                                        std::span<TissueInterval> out) const noexcept {
  const Vec3 path = segment.end - segment.start;
  const double length = path.norm();
  const Vec3 direction = length > 0 ? Vec3(path / length) : Vec3(Vec3::UnitZ());
  QueryCount count;
  const auto add = [&](double from, double to, RegionId region) {
    if (to <= from) return;
    if (count.size == out.size()) {
      count.truncated = true;
      return;
    }
    const Vec3 at = segment.start + from * direction - origin_;
    const Vec3 normal = from <= 0 ? Vec3(Vec3::Zero())
                        : balls_  ? Vec3(at.normalized())
                                  : Vec3(-into_);
    out[count.size++] = {from, to, region, normal.dot(direction) > 0 ? Vec3(-normal) : normal, 0};
  };
  // Nested convex bodies: going in through each in turn, then out in the reverse order.
  double at = 0;
  RegionId region = kOutside;
  std::size_t deepest = 0;
  for (; deepest < sizes_.size(); ++deepest) {
    const Span s = clip(deepest, segment.start, direction, length);
    if (s.to <= s.from) break;
    add(at, s.from, region);
    at = std::max(at, s.from);
    region = static_cast<RegionId>(kFirstRegion + deepest);
  }
  for (std::size_t i = deepest; i-- > 0;) {
    const Span s = clip(i, segment.start, direction, length);
    add(at, s.to, static_cast<RegionId>(kFirstRegion + i));
    at = std::max(at, s.to);
  }
  add(at, length, kOutside);
  return count;
}

}  // namespace artus
