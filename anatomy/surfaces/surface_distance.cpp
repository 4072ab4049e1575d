// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/surfaces/surface_distance.h"

#include <algorithm>
#include <cmath>

namespace artus {
namespace {

constexpr double kFar = 10;  // m, no distance of a body is larger
constexpr double kSamplesPerBox = 300;
constexpr double kMaxSamples = 1e5;
constexpr double kMaxParts = 200;  // along a side: one long triangle must not take all day

using Corners = std::array<Vec3, 3>;

Corners corners_of(const SurfaceMesh& mesh, const Triangle& t) {
  return {mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]};
}

bool before(const Vec3& a, const Vec3& b) {
  return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
}

/// The corners by position, whatever the face begins with.
Corners key_of(const SurfaceMesh& mesh, const Triangle& t) {
  Corners key = corners_of(mesh, t);
  std::sort(key.begin(), key.end(), before);
  return key;
}

bool before_key(const Corners& a, const Corners& b) {
  return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end(), before);
}

std::vector<Corners> sorted_keys(const SurfaceMesh& mesh) {
  std::vector<Corners> keys;
  keys.reserve(mesh.triangles.size());
  for (const Triangle& t : mesh.triangles) keys.push_back(key_of(mesh, t));
  std::sort(keys.begin(), keys.end(), before_key);
  return keys;
}

DistanceStatistics one_way(const SurfaceMesh& from, const SurfaceMesh& to, double spacing) {
  const std::vector<Corners> common = sorted_keys(to);
  const DistanceTree tree(to);
  std::vector<DistanceSample> measured;
  std::vector<SurfaceSample> samples;
  for (const Triangle& t : from.triangles) {
    if (std::binary_search(common.begin(), common.end(), key_of(from, t), before_key)) {
      measured.push_back({0, triangle_area(from, t)});
      continue;
    }
    samples.clear();
    append_samples(corners_of(from, t), spacing, samples);
    for (const SurfaceSample& s : samples)
      measured.push_back({tree.distance(s.position, kFar), s.area});
  }
  return compute_statistics(std::move(measured));
}

}  // namespace

void append_samples(const std::array<Vec3, 3>& corners, double spacing,
                    std::vector<SurfaceSample>& samples) {
  const Vec3 u = corners[1] - corners[0];
  const Vec3 v = corners[2] - corners[0];
  const double longest = std::max({u.norm(), v.norm(), (u - v).norm()});
  const int n = static_cast<int>(std::clamp(std::ceil(longest / spacing), 1.0, kMaxParts));
  const double area = u.cross(v).norm() / 2 / (n * n);
  for (const Vec3& corner : corners) samples.push_back({corner, 0});
  const auto add = [&](double i, double j) {
    samples.push_back({corners[0] + i / n * u + j / n * v, area});
  };
  for (int i = 0; i < n; ++i) {
    for (int j = 0; i + j < n; ++j) {
      add(i + 1.0 / 3, j + 1.0 / 3);
      if (i + j + 1 < n) add(i + 2.0 / 3, j + 2.0 / 3);
    }
  }
}

DistanceStatistics compute_statistics(std::vector<DistanceSample> samples) {
  DistanceStatistics s;
  if (samples.empty()) return s;
  std::sort(samples.begin(), samples.end(), [](const DistanceSample& a, const DistanceSample& b) {
    return a.distance < b.distance;
  });
  double area = 0;
  for (const DistanceSample& x : samples) {
    area += x.area;
    s.mean += x.area * x.distance;
  }
  s.mean = area > 0 ? s.mean / area : 0;
  s.max = samples.back().distance;
  double sum = 0;
  for (const DistanceSample& x : samples) {
    sum += x.area;
    s.percentile95 = x.distance;
    if (sum >= 0.95 * area) break;
  }
  return s;
}

DistanceStatistics worse_of(const DistanceStatistics& a, const DistanceStatistics& b) noexcept {
  return {std::max(a.mean, b.mean), std::max(a.percentile95, b.percentile95),
          std::max(a.max, b.max)};
}

DistanceStatistics measure_distance(const SurfaceMesh& a, const SurfaceMesh& b) {
  Eigen::AlignedBox3d box;
  for (const Triangle& t : a.triangles)
    for (const auto v : t) box.extend(a.vertices[v]);
  const double area = std::max(surface_area(a), surface_area(b));
  const double spacing =
      std::max(box.diagonal().norm() / kSamplesPerBox, std::sqrt(2 * area / kMaxSamples));
  return worse_of(one_way(a, b, spacing), one_way(b, a, spacing));
}

}  // namespace artus
