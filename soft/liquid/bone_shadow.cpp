// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/soft/liquid/bone_shadow.h"

#include <algorithm>
#include <cmath>

namespace artus {
namespace {

constexpr double kSmall = 0.03;  // rad under which a piece of bone is a point
constexpr int kDeepest = 40;     // halvings of a triangle
constexpr double kSafe = 0.99;   // of a piece's nearest corner, its nearest point
constexpr double kFade = 0.7;    // of nearness, from one node to the next beside a bone's edge
constexpr int kFadeNodes = 12;   // after which next to nothing is left
constexpr double kClosest = 1e-3;

/// Where a direction lies on the unfolded octahedron, -1 .. 1; its lower half is turned outward.
Eigen::Vector2d unfold(const Vec3& y) {
  const double size = y.lpNorm<1>();
  const Eigen::Vector2d p = y.head<2>() / size;
  if (y.z() >= 0) return p;
  return {std::copysign(1 - std::abs(p.y()), p.x()), std::copysign(1 - std::abs(p.x()), p.y())};
}

}  // namespace

BoneShadow::BoneShadow() : nodes_(static_cast<std::size_t>(kNodes) * kNodes, 0.0) {}

/// Beyond a side the octahedron goes on with that side's other half.
double& BoneShadow::node(int i, int j) {
  constexpr int kLast = kNodes - 1;
  if (i < 0 || i > kLast) {
    i = i < 0 ? -i : 2 * kLast - i;
    j = kLast - j;
  }
  if (j < 0 || j > kLast) {
    j = j < 0 ? -j : 2 * kLast - j;
    i = kLast - i;
  }
  return nodes_[static_cast<std::size_t>(j * kNodes + i)];
}

void BoneShadow::mark(const Vec3& point, double nearness) {
  const Eigen::Vector2d p = (unfold(point).array() + 1) * (kNodes - 1) / 2;
  const int i = static_cast<int>(p.x());
  const int j = static_cast<int>(p.y());
  // Every node that a direction of the piece may lie between, and one more.
  for (int dj = -1; dj <= 2; ++dj)
    for (int di = -1; di <= 2; ++di) {
      double& value = node(i + di, j + dj);
      value = std::max(value, nearness);
    }
}

void BoneShadow::add_part(const std::array<Vec3, 3>& triangle, int depth) {
  std::array<double, 3> edges{};
  for (std::size_t k = 0; k < 3; ++k) edges[k] = (triangle[(k + 1) % 3] - triangle[k]).norm();
  const auto longest =
      static_cast<std::size_t>(std::max_element(edges.begin(), edges.end()) - edges.begin());
  const double nearest = std::min({triangle[0].norm(), triangle[1].norm(), triangle[2].norm()});
  if (nearest - edges[longest] > kFarthest) return;
  if (edges[longest] < kSmall * nearest || depth == kDeepest || nearest < kClosest) {
    const double d = kSafe * std::max(nearest, kClosest);
    for (const Vec3& corner : triangle)
      if (corner.norm() > 0) mark(corner, 1 / (d * d * d));
    return;
  }
  const Vec3 middle = (triangle[longest] + triangle[(longest + 1) % 3]) / 2;
  std::array<Vec3, 3> part = triangle;
  part[longest] = middle;
  add_part(part, depth + 1);
  part = triangle;
  part[(longest + 1) % 3] = middle;
  add_part(part, depth + 1);
}

void BoneShadow::add(const std::array<Vec3, 3>& triangle) {
  add_part(triangle, 0);
}

/// The two halves of a side are the same directions, and the four corners are one.
void BoneShadow::close_seams() {
  constexpr int kLast = kNodes - 1;
  const auto same = [&](double& a, double& b) {
    a = b = std::max(a, b);
  };
  for (int k = 0; k <= kLast; ++k) {
    same(node(k, 0), node(kLast - k, 0));
    same(node(k, kLast), node(kLast - k, kLast));
    same(node(0, k), node(0, kLast - k));
    same(node(kLast, k), node(kLast, kLast - k));
  }
  same(node(0, 0), node(kLast, kLast));
  same(node(0, kLast), node(kLast, kLast));
  same(node(kLast, 0), node(kLast, kLast));
}

void BoneShadow::spread() {
  close_seams();
  for (int k = 0; k < kFadeNodes; ++k) {
    const std::vector<double> before = nodes_;
    for (int j = 0; j < kNodes; ++j)
      for (int i = 0; i < kNodes; ++i) {
        const double value = kFade * before[static_cast<std::size_t>(j * kNodes + i)];
        if (!(value > 0)) continue;
        for (const auto& [di, dj] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
          double& next = node(i + di, j + dj);
          next = std::max(next, value);
        }
      }
  }
  close_seams();
}

double BoneShadow::nearness(const Vec3& y) const {
  const Eigen::Vector2d p = (unfold(y).array() + 1) * (kNodes - 1) / 2;
  const int i = std::clamp(static_cast<int>(p.x()), 0, kNodes - 2);
  const int j = std::clamp(static_cast<int>(p.y()), 0, kNodes - 2);
  const double fx = p.x() - i;
  const double fy = p.y() - j;
  const double* at = &nodes_[static_cast<std::size_t>(j * kNodes + i)];
  return (1 - fy) * ((1 - fx) * at[0] + fx * at[1]) +
         fy * ((1 - fx) * at[kNodes] + fx * at[kNodes + 1]);
}

}  // namespace artus
