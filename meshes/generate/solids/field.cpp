// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/meshes/generate/solids/field.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace artus {
namespace {

// The polynomial smooth minimum: equal to min where the arguments differ by `blend` or more.
double smooth_min(double a, double b, double blend) {
  if (blend <= 0) return std::min(a, b);
  const double h = std::max(blend - std::abs(a - b), 0.0) / blend;
  return std::min(a, b) - 0.25 * blend * h * h;
}

// Of an ellipsoid about the origin, to first order.
template <int N>
double ellipsoid_value(const Eigen::Matrix<double, N, 1>& local,
                       const Eigen::Matrix<double, N, 1>& half_axes) {
  const Eigen::Matrix<double, N, 1> scaled = local.cwiseQuotient(half_axes);
  const double steepness = scaled.cwiseQuotient(half_axes).norm();
  if (steepness <= 0) return -half_axes.minCoeff();
  return scaled.norm() * (scaled.norm() - 1) / steepness;
}

}  // namespace

Field make_ball(const Vec3& centre, double radius) {
  return [centre, radius](const Vec3& p) {
    return (p - centre).norm() - radius;
  };
}

Field make_ellipsoid(const Vec3& centre, const Vec3& half_axes, const Eigen::Matrix3d& axes) {
  return [centre, half_axes, axes](const Vec3& p) {
    return ellipsoid_value<3>(axes.transpose() * (p - centre), half_axes);
  };
}

Field make_cushion(Field side, double height, const Vec3& centre, const Vec3& half_axes,
                   const Eigen::Matrix3d& axes) {
  const double above = side(centre) - height;
  const Eigen::Vector4d half(half_axes.x(), half_axes.y(), half_axes.head<2>().minCoeff(),
                             half_axes.z());
  return [side = std::move(side), height, centre, half, axes, above](const Vec3& p) {
    const Vec3 local = axes.transpose() * (p - centre);
    const double across = side(p) - height;
    const double bent_back = local.z() - (across - above);
    return ellipsoid_value<4>({local.x(), local.y(), bent_back, across}, half);
  };
}

Field make_half_space(const Vec3& point, const Vec3& outward) {
  const Vec3 normal = outward.normalized();
  return [point, normal](const Vec3& p) {
    return normal.dot(p - point);
  };
}

Field grow(Field field, double distance) {
  return [field = std::move(field), distance](const Vec3& p) {
    return field(p) - distance;
  };
}

Field unite(Field a, Field b, double blend) {
  return [a = std::move(a), b = std::move(b), blend](const Vec3& p) {
    return smooth_min(a(p), b(p), blend);
  };
}

Field intersect(Field a, Field b, double blend) {
  return [a = std::move(a), b = std::move(b), blend](const Vec3& p) {
    return -smooth_min(-a(p), -b(p), blend);
  };
}

Field subtract(Field a, Field b, double blend) {
  return [a = std::move(a), b = std::move(b), blend](const Vec3& p) {
    return -smooth_min(-a(p), b(p), blend);
  };
}

}  // namespace artus
