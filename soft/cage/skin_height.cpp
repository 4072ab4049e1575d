// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/soft/cage/skin_height.h"

#include <algorithm>
#include <cmath>

namespace artus {
namespace {

constexpr double kColumns = 1.5e-3;  // m across
constexpr double kDown = 0.75e-3;    // m along z, then halved
constexpr int kHalvings = 5;
constexpr double kOffSkin = 1e-3;  // m above the skin from which on all moves alike
constexpr double kNoBody = 1;      // m: no body in reach

/// The z at which the body begins, from `top` to `bottom`.
double height_at(const MaterialField& field, Vec3 p_C, double top, double bottom) {
  const auto is_body = [&](double z) {
    p_C.z() = z;
    return field.at(p_C) != kNoMaterial;
  };
  double z = top;
  while (z < bottom && !is_body(z)) z += kDown;
  if (!(z < bottom)) return kNoBody;
  double step = kDown;
  for (int k = 0; k < kHalvings; ++k) {
    step /= 2;
    if (is_body(z - step)) z -= step;
  }
  return z;
}

}  // namespace

SkinHeight::SkinHeight(const Cage& cage, const MaterialField& field) {
  if (cage.cells().empty()) return;
  Vec3 low = Vec3::Constant(kNoBody);
  Vec3 high = -low;
  for (const CageCell& cell : cage.cells()) {
    low = low.cwiseMin(cage.low_corner(cell));
    high = high.cwiseMax(cage.low_corner(cell) + Vec3::Constant(cage.edge(cell)));
  }
  low_ = low;
  for (std::size_t a = 0; a < 2; ++a) {
    const auto axis = static_cast<Eigen::Index>(a);
    size_[a] = 1 + static_cast<int>(std::ceil((high[axis] - low[axis]) / kColumns));
  }
  for (int y = 0; y < size_[1]; ++y)
    for (int x = 0; x < size_[0]; ++x)
      z_.push_back(height_at(field, low + Vec3(kColumns * x, kColumns * y, 0), low.z(), high.z()));
}

SkinHeight::Below SkinHeight::below(const Vec3& p_C) const noexcept {
  Below out{p_C, false, {}};
  const double x = (p_C.x() - low_.x()) / kColumns;
  const double y = (p_C.y() - low_.y()) / kColumns;
  if (!(x >= 0 && x < size_[0] - 1 && y >= 0 && y < size_[1] - 1)) return out;
  const int i = static_cast<int>(x);
  const int j = static_cast<int>(y);
  const double s = x - i;
  const double t = y - j;
  const double near = (1 - s) * at(i, j) + s * at(i + 1, j);
  const double far = (1 - s) * at(i, j + 1) + s * at(i + 1, j + 1);
  const double z = (1 - t) * near + t * far - kOffSkin;
  const double highest = std::max({at(i, j), at(i + 1, j), at(i, j + 1), at(i + 1, j + 1)});
  if (!(highest < kNoBody) || !(p_C.z() < z)) return out;
  out.p_C.z() = z;
  out.lowered = true;
  out.slope = {
      ((1 - t) * (at(i + 1, j) - at(i, j)) + t * (at(i + 1, j + 1) - at(i, j + 1))) / kColumns,
      (far - near) / kColumns};
  return out;
}

}  // namespace artus
