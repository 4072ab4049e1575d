// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/meshes/generate/solids/sweep.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "artus/detail/core/check.h"

namespace artus {
namespace {

constexpr std::size_t kSamplesPerSpan = 8;

// Catmull-Rom weights of the four stations around a span at parameter t in [0, 1].
std::array<double, 4> spline_weights(double t) {
  const double t2 = t * t;
  const double t3 = t2 * t;
  return {0.5 * (-t3 + 2 * t2 - t), 0.5 * (3 * t3 - 5 * t2 + 2), 0.5 * (-3 * t3 + 4 * t2 + t),
          0.5 * (t3 - t2)};
}

RibbonStation blend(const std::array<const RibbonStation*, 4>& around, double t) {
  const std::array<double, 4> w = spline_weights(t);
  RibbonStation s;
  s.normal = Vec3::Zero();
  for (std::size_t i = 0; i < 4; ++i) s.centre += w.at(i) * around.at(i)->centre;
  s.normal = ((1 - t) * around[1]->normal + t * around[2]->normal).normalized();
  s.half_width = (1 - t) * around[1]->half_width + t * around[2]->half_width;
  s.half_thickness = (1 - t) * around[1]->half_thickness + t * around[2]->half_thickness;
  return s;
}

// The stations of a fine polyline along the curve; a closed curve ends where it starts.
std::vector<RibbonStation> refine(const std::vector<RibbonStation>& stations, bool closed) {
  const auto n = static_cast<std::ptrdiff_t>(stations.size());
  const auto at = [&](std::ptrdiff_t i) {
    const std::ptrdiff_t k = closed ? (i % n + n) % n : std::clamp<std::ptrdiff_t>(i, 0, n - 1);
    return &stations[static_cast<std::size_t>(k)];
  };
  std::vector<RibbonStation> fine;
  const std::ptrdiff_t spans = closed ? n : n - 1;
  for (std::ptrdiff_t span = 0; span < spans; ++span) {
    for (std::size_t k = 0; k < kSamplesPerSpan; ++k) {
      fine.push_back(blend({at(span - 1), at(span), at(span + 1), at(span + 2)},
                           static_cast<double>(k) / kSamplesPerSpan));
    }
  }
  fine.push_back(*at(spans));
  return fine;
}

// The place on the polyline nearest to a point, and how the section lies there.
struct Foot {
  RibbonStation station;
  Vec3 tangent = Vec3::UnitX();
};

Foot find_foot(const std::vector<RibbonStation>& path, const Vec3& p) {
  double nearest = std::numeric_limits<double>::infinity();
  std::size_t segment = 0;
  double parameter = 0;
  for (std::size_t i = 0; i + 1 < path.size(); ++i) {
    const Vec3 along = path[i + 1].centre - path[i].centre;
    const double t = std::clamp(along.dot(p - path[i].centre) / along.squaredNorm(), 0.0, 1.0);
    const double distance = (path[i].centre + t * along - p).squaredNorm();
    if (distance < nearest) {
      nearest = distance;
      segment = i;
      parameter = t;
    }
  }
  const RibbonStation& a = path[segment];
  const RibbonStation& b = path[segment + 1];
  Foot foot;
  foot.tangent = (b.centre - a.centre).normalized();
  foot.station.centre = a.centre + parameter * (b.centre - a.centre);
  foot.station.normal = (1 - parameter) * a.normal + parameter * b.normal;
  foot.station.half_width = (1 - parameter) * a.half_width + parameter * b.half_width;
  foot.station.half_thickness = (1 - parameter) * a.half_thickness + parameter * b.half_thickness;
  return foot;
}

double ribbon_value(const Foot& foot, const Vec3& p, double power) {
  const RibbonStation& s = foot.station;
  const Vec3 normal = (s.normal - foot.tangent * foot.tangent.dot(s.normal)).normalized();
  const Vec3 offset = p - s.centre;
  const double thick = offset.dot(normal);
  const double wide = offset.dot(foot.tangent.cross(normal));
  const double along = offset.dot(foot.tangent);
  const Vec3 half(s.half_width, s.half_thickness, s.half_thickness);
  const Vec3 scaled = Vec3(wide, thick, along).cwiseQuotient(half).cwiseAbs();
  const double size = std::pow(scaled.array().pow(power).sum(), 1 / power);
  if (size <= 0) return -half.minCoeff();
  // The size is homogeneous of degree one; its gradient makes a distance of it.
  const Vec3 slope = (scaled / size).array().pow(power - 1).matrix().cwiseQuotient(half);
  const double to_first_order = (size - 1) / slope.norm();
  if (size <= 1) return to_first_order;
  // Far beyond the rim of a thin section the first order is much too near; the box is not.
  const Vec3 beyond = (Vec3(wide, thick, along).cwiseAbs() - half).cwiseMax(0);
  return std::max(to_first_order, beyond.norm());
}

double distance_to_triangle(const std::array<Vec3, 3>& t, const Vec3& p) {
  const Vec3 normal = (t[1] - t[0]).cross(t[2] - t[0]);
  bool above = true;
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3& a = t.at(i);
    const Vec3 edge = t.at((i + 1) % 3) - a;
    above = above && edge.cross(normal).dot(p - a) <= 0;
    const double along = std::clamp(edge.dot(p - a) / edge.squaredNorm(), 0.0, 1.0);
    nearest = std::min(nearest, (a + along * edge - p).norm());
  }
  return above ? std::abs(normal.normalized().dot(p - t[0])) : nearest;
}

std::vector<RibbonStation> round_stations(const std::vector<TubeStation>& stations) {
  std::vector<RibbonStation> flat;
  flat.reserve(stations.size());
  for (const TubeStation& s : stations) {
    flat.push_back({s.centre, Vec3::UnitZ(), s.radius, s.radius});
  }
  return flat;
}

// The union of the spans, so that it changes continuously where the nearest span changes.
double round_value(const std::vector<RibbonStation>& path, const Vec3& p) {
  double value = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i + 1 < path.size(); ++i) {
    const RibbonStation& a = path[i];
    const RibbonStation& b = path[i + 1];
    const Vec3 along = b.centre - a.centre;
    const double t = std::clamp(along.dot(p - a.centre) / along.squaredNorm(), 0.0, 1.0);
    const double radius = (1 - t) * a.half_width + t * b.half_width;
    value = std::min(value, (a.centre + t * along - p).norm() - radius);
  }
  return value;
}

Field make_round(std::vector<RibbonStation> path) {
  return [path = std::move(path)](const Vec3& p) {
    return round_value(path, p);
  };
}

}  // namespace

Field make_tube(const std::vector<TubeStation>& stations) {
  ARTUS_REQUIRE(stations.size() >= 2, "a tube needs two stations");
  return make_round(refine(round_stations(stations), false));
}

Field make_ring(const std::vector<Vec3>& points, double radius) {
  ARTUS_REQUIRE(points.size() >= 3, "a ring needs three points");
  std::vector<TubeStation> stations;
  stations.reserve(points.size());
  for (const Vec3& p : points) stations.push_back({p, radius});
  return make_round(refine(round_stations(stations), true));
}

Field make_ribbon(const std::vector<RibbonStation>& stations, double power) {
  ARTUS_REQUIRE(stations.size() >= 2 && power >= 2,
                "a ribbon needs two stations and a power of at least 2");
  return [path = refine(stations, false), power](const Vec3& p) {
    return ribbon_value(find_foot(path, p), p, power);
  };
}

Field make_plate(const std::vector<std::array<Vec3, 3>>& triangles, double radius) {
  ARTUS_REQUIRE(!triangles.empty(), "a plate needs a triangle");
  return [triangles, radius](const Vec3& p) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const auto& t : triangles) nearest = std::min(nearest, distance_to_triangle(t, p));
    return nearest - radius;
  };
}

}  // namespace artus
