// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/anatomy/surfaces/distance_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace artus {
namespace {

constexpr std::uint32_t kLeafSize = 4;
constexpr double kOpeningRatio = 2.3;

// Closest point of a triangle by its Voronoi regions [Ericson2004] section 5.1.5.
double squared_distance(const Vec3& p, const std::array<Vec3, 3>& t) {
  const Vec3 ab = t[1] - t[0];
  const Vec3 ac = t[2] - t[0];
  const Vec3 ap = p - t[0];
  const double d1 = ab.dot(ap);
  const double d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return ap.squaredNorm();
  const Vec3 bp = p - t[1];
  const double d3 = ab.dot(bp);
  const double d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) return bp.squaredNorm();
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return (ap - d1 / (d1 - d3) * ab).squaredNorm();
  const Vec3 cp = p - t[2];
  const double d5 = ab.dot(cp);
  const double d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6) return cp.squaredNorm();
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return (ap - d2 / (d2 - d6) * ac).squaredNorm();
  const double va = d3 * d6 - d5 * d4;
  const double along = d4 - d3;
  if (va <= 0 && along >= 0 && d5 - d6 >= 0) {
    return (bp - along / (along + d5 - d6) * (t[2] - t[1])).squaredNorm();
  }
  const double sum = va + vb + vc;
  return (ap - vb / sum * ab - vc / sum * ac).squaredNorm();
}

double squared_distance_to_box(const Vec3& p, const std::array<float, 3>& lower,
                               const std::array<float, 3>& upper) {
  double sum = 0;
  for (std::size_t a = 0; a < 3; ++a) {
    const double at = p[static_cast<Eigen::Index>(a)];
    const double d =
        std::max({static_cast<double>(lower[a]) - at, at - static_cast<double>(upper[a]), 0.0});
    sum += d * d;
  }
  return sum;
}

// Signed solid angle over 4 pi [VanOosterom1983] eq. 8.
double solid_angle_share(const Vec3& p, const std::array<Vec3, 3>& t) {
  const Vec3 a = t[0] - p;
  const Vec3 b = t[1] - p;
  const Vec3 c = t[2] - p;
  const double la = a.norm();
  const double lb = b.norm();
  const double lc = c.norm();
  const double num = a.dot(b.cross(c));
  const double den = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
  return std::atan2(num, den) / (2 * std::numbers::pi);
}

Vec3 centroid(const std::array<Vec3, 3>& t) {
  return (t[0] + t[1] + t[2]) / 3;
}

}  // namespace

DistanceTree::DistanceTree(const SurfaceMesh& mesh)
    : lower_(Vec3::Constant(std::numeric_limits<double>::infinity())), upper_(-lower_) {
  triangles_.reserve(mesh.triangles.size());
  for (const Triangle& t : mesh.triangles) {
    triangles_.push_back({mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]});
  }
  if (triangles_.empty()) return;
  nodes_.reserve(triangles_.size());
  nodes_.emplace_back();
  build(0, 0, static_cast<std::uint32_t>(triangles_.size()));
  lower_ = nodes_[0].lower;
  upper_ = nodes_[0].upper;
  flatten();
}

void DistanceTree::flatten() {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  boxes_.reserve(nodes_.size());
  for (const Node& node : nodes_) {
    FlatBox box;
    for (std::size_t a = 0; a < 3; ++a) {
      const auto axis = static_cast<Eigen::Index>(a);
      box.lower[a] = std::nextafter(static_cast<float>(node.lower[axis]), -kInfinity);
      box.upper[a] = std::nextafter(static_cast<float>(node.upper[axis]), kInfinity);
    }
    box.first = node.first;
    box.count = node.count;
    boxes_.push_back(box);
  }
}

void DistanceTree::summarise(Node& node, std::uint32_t first, std::uint32_t count) const {
  node.lower = Vec3::Constant(std::numeric_limits<double>::infinity());
  node.upper = -node.lower;
  double area_sum = 0;
  for (std::uint32_t i = first; i < first + count; ++i) {
    const Corners& t = triangles_[i];
    for (const Vec3& v : t) {
      node.lower = node.lower.cwiseMin(v);
      node.upper = node.upper.cwiseMax(v);
    }
    const Vec3 area_vector = (t[1] - t[0]).cross(t[2] - t[0]) / 2;
    const double area = area_vector.norm();
    node.dipole += area_vector;
    node.centre += area * centroid(t);
    area_sum += area;
  }
  node.centre = area_sum > 0 ? Vec3(node.centre / area_sum) : Vec3((node.lower + node.upper) / 2);
  const Vec3 reach = (node.centre - node.lower).cwiseMax(node.upper - node.centre);
  node.far2 = kOpeningRatio * kOpeningRatio * reach.squaredNorm();
}

void DistanceTree::build(std::uint32_t node, std::uint32_t first, std::uint32_t count) {
  summarise(nodes_[node], first, count);
  if (count <= kLeafSize) {
    nodes_[node].first = first;
    nodes_[node].count = count;
    return;
  }
  Eigen::Index axis = 0;
  (nodes_[node].upper - nodes_[node].lower).maxCoeff(&axis);
  const auto begin = triangles_.begin() + first;
  const std::uint32_t half = count / 2;
  std::nth_element(begin, begin + half, begin + count, [axis](const Corners& a, const Corners& b) {
    return centroid(a)[axis] < centroid(b)[axis];
  });
  const auto left = static_cast<std::uint32_t>(nodes_.size());
  nodes_[node].first = left;
  nodes_.resize(nodes_.size() + 2);
  build(left, first, half);
  build(left + 1, first + half, count - half);
}

double DistanceTree::distance(const Vec3& p, double bound) const {
  if (empty()) return bound;
  double best = bound * bound;
  std::array<std::pair<double, std::uint32_t>, 64> stack{};
  std::size_t depth = 0;
  stack[depth++] = {0, 0};
  while (depth > 0) {
    const auto [nearest, index] = stack[--depth];
    if (nearest >= best) continue;
    const FlatBox& node = boxes_[index];
    if (node.count > 0) {
      for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
        best = std::min(best, squared_distance(p, triangles_[i]));
      }
      continue;
    }
    std::array<std::pair<double, std::uint32_t>, 2> children;
    for (std::uint32_t k = 0; k < 2; ++k) {
      const FlatBox& child = boxes_[node.first + k];
      children[k] = {squared_distance_to_box(p, child.lower, child.upper), node.first + k};
    }
    if (children[0].first < children[1].first) std::swap(children[0], children[1]);
    for (const auto& child : children) {
      if (child.first < best) stack[depth++] = child;
    }
  }
  return std::sqrt(best);
}

double DistanceTree::winding_number(const Vec3& p) const {
  if (empty()) return 0;
  double sum = 0;
  std::array<std::uint32_t, 64> stack{};
  std::size_t depth = 0;
  stack[depth++] = 0;
  while (depth > 0) {
    const Node& node = nodes_[stack[--depth]];
    const Vec3 r = node.centre - p;
    const double r2 = r.squaredNorm();
    if (r2 > node.far2) {
      sum += r.dot(node.dipole) / (4 * std::numbers::pi * r2 * std::sqrt(r2));
    } else if (node.count > 0) {
      for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
        sum += solid_angle_share(p, triangles_[i]);
      }
    } else {
      stack[depth++] = node.first;
      stack[depth++] = node.first + 1;
    }
  }
  return sum;
}

}  // namespace artus
