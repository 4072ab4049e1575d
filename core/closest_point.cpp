// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/core/closest_point.h"

#include <algorithm>

namespace artus {
namespace {

Vec3 closest_point_on_edge(const Vec3& p, const Vec3& a, const Vec3& b) noexcept {
  const Vec3 ab = b - a;
  const double squared = ab.squaredNorm();
  if (!(squared > 0)) return a;
  return a + std::clamp(ab.dot(p - a) / squared, 0.0, 1.0) * ab;
}

}  // namespace

Vec3 closest_point_on_triangle(const Vec3& p, const std::array<Vec3, 3>& corners) noexcept {
  const auto& [a, b, c] = corners;
  const Vec3 ab = b - a;
  const Vec3 ac = c - a;
  const Vec3 ap = p - a;
  const double d1 = ab.dot(ap);
  const double d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return a;
  const Vec3 bp = p - b;
  const double d3 = ab.dot(bp);
  const double d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) return b;
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return closest_point_on_edge(p, a, b);
  const Vec3 cp = p - c;
  const double d5 = ab.dot(cp);
  const double d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6) return c;
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return closest_point_on_edge(p, a, c);
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) return closest_point_on_edge(p, b, c);
  const double scale = 1 / (va + vb + vc);
  return a + (vb * scale) * ab + (vc * scale) * ac;
}

}  // namespace artus
