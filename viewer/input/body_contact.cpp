// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/viewer/input/body_contact.h"

#include <array>

namespace artus {
namespace {

constexpr double kReach = 40e-3;  // m above and below a face where skin is looked for
constexpr double kAround = 5e-3;  // m from the face's centre, over which its slope is averaged

}  // namespace

std::optional<double> BodyContact::find_skin(const Vec3& p_W, const Vec3& direction_W,
                                             double reach) const {
  if (scene == nullptr) return std::nullopt;
  const Pose X_JW = X_WJ.inverse();
  std::array<Crossing, 32> crossings;
  const QueryCount count =
      scene->find_crossings({X_JW * p_W, X_JW * Vec3(p_W + reach * direction_W)}, crossings);
  for (std::size_t i = 0; i < count.size; ++i) {
    if (crossings[i].from == kOutside) return crossings[i].depth;
  }
  return std::nullopt;
}

std::optional<double> BodyContact::find_bone(const Vec3& p_W, const Vec3& direction_W,
                                             double reach) const {
  if (scene == nullptr) return std::nullopt;
  const Pose X_JW = X_WJ.inverse();
  std::array<Crossing, 64> crossings;
  const QueryCount count =
      scene->find_crossings({X_JW * p_W, X_JW * Vec3(p_W + reach * direction_W)}, crossings);
  for (std::size_t i = 0; i < count.size; ++i) {
    if (scene->joint().tissue_of(crossings[i].to).haptic.hard) return crossings[i].depth;
  }
  return std::nullopt;
}

std::optional<double> BodyContact::find_gap(const Pose& X_WP) const {
  const Vec3 down = X_WP.linear().col(2);
  const auto depth = find_skin(X_WP.translation() - kReach * down, down, 2 * kReach);
  if (!depth) return std::nullopt;
  return *depth - kReach;
}

std::optional<Vec3> BodyContact::find_normal(const Pose& X_WP) const {
  std::array<double, 4> height{};
  constexpr std::array<std::array<double, 2>, 4> kAt{{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}};
  for (std::size_t i = 0; i < kAt.size(); ++i) {
    Pose beside = X_WP;
    beside.translation() += X_WP.linear() * (kAround * Vec3(kAt[i][0], kAt[i][1], 0));
    const auto gap = find_gap(beside);
    if (!gap) return std::nullopt;
    height[i] = *gap;  // along +z, into the body
  }
  const Vec3 along_x(2 * kAround, 0, height[0] - height[1]);
  const Vec3 along_y(0, 2 * kAround, height[2] - height[3]);
  return X_WP.linear() * Vec3(along_y.cross(along_x).normalized());
}

}  // namespace artus
