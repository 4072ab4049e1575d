// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/devices/kit/lens.h"

namespace artus::kit {
namespace {

Eigen::Vector2d bend(const std::array<double, 5>& d, const Eigen::Vector2d& p) {
  const double r2 = p.squaredNorm();
  const double radial = 1 + r2 * (d[0] + r2 * (d[1] + r2 * d[4]));
  return radial * p + Eigen::Vector2d(2 * d[2] * p.x() * p.y() + d[3] * (r2 + 2 * p.x() * p.x()),
                                      d[2] * (r2 + 2 * p.y() * p.y()) + 2 * d[3] * p.x() * p.y());
}

}  // namespace

cv::Matx33d Lens::matrix() const {
  return {fx, 0, cx, 0, fy, cy, 0, 0, 1};
}

Eigen::Vector2d Lens::looks_at(const Eigen::Vector2d& pixel) const {
  constexpr int kSteps = 8;  // of the fixed point; each takes a digit and more at webcams' bends
  const Eigen::Vector2d bent((pixel.x() - cx) / fx, (pixel.y() - cy) / fy);
  Eigen::Vector2d p = bent;
  for (int i = 0; i < kSteps; ++i) p += bent - bend(distortion, p);
  return p;
}

Eigen::Vector2d Lens::project(const Vec3& p_C) const {
  const Eigen::Vector2d bent = bend(distortion, p_C.head<2>() / p_C.z());
  return {fx * bent.x() + cx, fy * bent.y() + cy};
}

}  // namespace artus::kit
