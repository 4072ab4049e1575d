// SPDX-License-Identifier: AGPL-3.0-or-later
#include "tests/raycast/brute_force.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "artus/detail/core/noise.h"

namespace artus::test {
namespace {

/// Whether the line passes the directed edge a -> b on its positive side; the reversed edge gives
/// exactly the opposite answer.
bool passes_positive(const TetMesh& mesh, std::uint32_t a, std::uint32_t b, const Vec3& origin,
                     const Vec3& direction) {
  const bool swapped = a > b;
  if (swapped) std::swap(a, b);
  const Vec3 u = mesh.vertices[a] - origin;
  const Vec3 v = mesh.vertices[b] - origin;
  const bool positive = direction.dot(u.cross(v)) >= 0;
  return positive != swapped;
}

double distance_to_edge(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 ab = b - a;
  const double t = std::clamp((p - a).dot(ab) / ab.squaredNorm(), 0.0, 1.0);
  return (p - a - t * ab).norm();
}

}  // namespace

std::vector<Crossing> brute_force_crossings(const TetMesh& mesh, const Segment& segment) {
  std::vector<Crossing> crossings;
  const double length = (segment.end - segment.start).norm();
  const Vec3 direction = (segment.end - segment.start) / length;
  for (std::size_t i = 0; i < mesh.interfaces.size(); ++i) {
    const Interface& face = mesh.interfaces[i];
    const auto& [a, b, c] = face.vertices;
    const bool side = passes_positive(mesh, a, b, segment.start, direction);
    if (passes_positive(mesh, b, c, segment.start, direction) != side) continue;
    if (passes_positive(mesh, c, a, segment.start, direction) != side) continue;
    const Vec3 normal = (mesh.vertices[b] - mesh.vertices[a])
                            .cross(mesh.vertices[c] - mesh.vertices[a])
                            .normalized();
    const double cosine = normal.dot(direction);
    if (cosine == 0) continue;
    const double depth = normal.dot(mesh.vertices[a] - segment.start) / cosine;
    if (depth < 0 || depth >= length) continue;
    crossings.push_back({depth, cosine < 0 ? normal : Vec3(-normal),
                         cosine < 0 ? face.front : face.back, cosine < 0 ? face.back : face.front,
                         static_cast<std::uint32_t>(i)});
  }
  std::sort(crossings.begin(), crossings.end(),
            [](const Crossing& x, const Crossing& y) { return x.depth < y.depth; });
  return crossings;
}

double brute_force_distance(const TetMesh& mesh, const Vec3& p) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Interface& face : mesh.interfaces) {
    const Vec3& a = mesh.vertices[face.vertices[0]];
    const Vec3& b = mesh.vertices[face.vertices[1]];
    const Vec3& c = mesh.vertices[face.vertices[2]];
    const Vec3 normal = (b - a).cross(c - a).normalized();
    const double height = normal.dot(p - a);
    const Vec3 q = p - height * normal;
    const bool inside = normal.dot((b - a).cross(q - a)) >= 0 &&
                        normal.dot((c - b).cross(q - b)) >= 0 &&
                        normal.dot((a - c).cross(q - c)) >= 0;
    const double distance = inside ? std::abs(height)
                                   : std::min({distance_to_edge(p, a, b), distance_to_edge(p, b, c),
                                               distance_to_edge(p, c, a)});
    nearest = std::min(nearest, distance);
  }
  return nearest;
}

RegionId CellBody::label(int i, int j, int k) const {
  const auto outside = [&](int x) {
    return x < 0 || x >= n;
  };
  if (outside(i) || outside(j) || outside(k)) return kOutside;
  return labels[static_cast<std::size_t>((k * n + j) * n + i)];
}

CellBody make_cell_body(int n, double cell, const Vec3& centre, int labels, double jitter,
                        std::uint64_t seed) {
  CellBody body;
  body.n = n;
  body.cell = cell;
  body.low = centre - Vec3::Constant(0.5 * n * cell);
  body.joint.name = "cells";
  body.joint.tissues.resize(1);
  body.joint.regions.resize(static_cast<std::size_t>(kFirstRegion + labels));
  std::uint64_t counter = 0;
  for (int i = 0; i < n * n * n; ++i) {
    body.labels.push_back(static_cast<RegionId>(
        kFirstRegion + static_cast<int>(uniform_noise(seed, counter++) * labels)));
  }
  TetMesh& mesh = body.joint.mesh;
  const int m = n + 1;
  for (int k = 0; k < m; ++k) {
    for (int j = 0; j < m; ++j) {
      for (int i = 0; i < m; ++i) {
        const Vec3 move = random_point(seed + 1, counter++, Vec3::Zero(), jitter * cell);
        mesh.vertices.emplace_back(body.low + cell * Vec3(i, j, k) + move);
      }
    }
  }
  const auto vertex = [&](const std::array<int, 3>& at) {
    return static_cast<std::uint32_t>((at[2] * m + at[1]) * m + at[0]);
  };
  // The face between a cell and its neighbour below along `axis`, normal along +axis.
  const auto add_face = [&](const std::array<int, 3>& at, std::size_t axis) {
    std::array<int, 3> below = at;
    --below[axis];
    const RegionId front = body.label(at[0], at[1], at[2]);
    const RegionId back = body.label(below[0], below[1], below[2]);
    if (front == back) return;
    std::array<int, 3> b = at;
    std::array<int, 3> c = at;
    std::array<int, 3> d = at;
    ++b[(axis + 1) % 3];
    ++c[(axis + 1) % 3];
    ++c[(axis + 2) % 3];
    ++d[(axis + 2) % 3];
    mesh.interfaces.push_back({{vertex(at), vertex(b), vertex(c)}, front, back});
    mesh.interfaces.push_back({{vertex(at), vertex(c), vertex(d)}, front, back});
  };
  for (int k = 0; k < m; ++k) {
    for (int j = 0; j < m; ++j) {
      for (int i = 0; i < m; ++i) {
        if (j < n && k < n) add_face({i, j, k}, 0);
        if (k < n && i < n) add_face({i, j, k}, 1);
        if (i < n && j < n) add_face({i, j, k}, 2);
      }
    }
  }
  return body;
}

std::vector<Stretch> stretches(const std::vector<TissueInterval>& intervals, double shortest) {
  std::vector<Stretch> result;
  for (const TissueInterval& interval : intervals) {
    if (interval.exit - interval.entry <= shortest) continue;
    if (!result.empty() && result.back().region == interval.region) continue;
    result.push_back({interval.region, interval.entry});
  }
  return result;
}

std::vector<Stretch> stretches(const std::vector<Crossing>& crossings, double length,
                               double shortest) {
  std::vector<TissueInterval> intervals(1);
  intervals.back().region = crossings.empty() ? kOutside : crossings.front().from;
  for (const Crossing& crossing : crossings) {
    intervals.back().exit = crossing.depth;
    TissueInterval next;
    next.entry = crossing.depth;
    next.region = crossing.to;
    intervals.push_back(next);
  }
  intervals.back().exit = length;
  return stretches(intervals, shortest);
}

Vec3 random_point(std::uint64_t seed, std::uint64_t i, const Vec3& centre, double half) {
  const Vec3 unit(uniform_noise(seed, 3 * i), uniform_noise(seed, 3 * i + 1),
                  uniform_noise(seed, 3 * i + 2));
  return centre + half * (2 * unit - Vec3::Ones());
}

}  // namespace artus::test
