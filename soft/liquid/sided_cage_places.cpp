// SPDX-License-Identifier: AGPL-3.0-or-later
// Where points of the tissue are in the cage, and which side of the walls they belong to.
#include <algorithm>
#include <cmath>

#include "artus/detail/core/check.h"
#include "artus/detail/soft/liquid/sided_cage.h"

namespace artus {
namespace {

constexpr double kOff = 1e-3;  // of a sample's spacing, from a wall into tissue

bool crosses(const Vec3& a, const Vec3& b, const std::array<Vec3, 3>& t) {
  const auto side = [](const Vec3& p, const Vec3& q, const Vec3& r, const Vec3& s) {
    return (q - p).dot((r - p).cross(s - p));
  };
  const double from = side(a, t[0], t[1], t[2]);
  const double to = side(b, t[0], t[1], t[2]);
  if (from * to > 0 || (from == 0 && to == 0)) return false;
  const double u = side(a, b, t[0], t[1]);
  const double v = side(a, b, t[1], t[2]);
  const double w = side(a, b, t[2], t[0]);
  return (u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0);
}

}  // namespace

/// From a sample to those around it, the nearest first.
void SidedCage::list_offsets() {
  Index s{};
  for (s[2] = -kReach; s[2] <= kReach; ++s[2])
    for (s[1] = -kReach; s[1] <= kReach; ++s[1])
      for (s[0] = -kReach; s[0] <= kReach; ++s[0]) offsets_.push_back(s);
  const auto square = [](const Index& i) {
    return i[0] * i[0] + i[1] * i[1] + i[2] * i[2];
  };
  std::stable_sort(offsets_.begin(), offsets_.end(),
                   [&](const Index& x, const Index& y) { return square(x) < square(y); });
}

/// Whether no wall is between two points, the first of them in a cube.
bool SidedCage::sees(const Vec3& a, const Vec3& b) const {
  Index c{};
  for (int k = 0; k < 3; ++k) {
    const auto i = static_cast<std::size_t>(k);
    c[i] = std::clamp(static_cast<std::int32_t>(std::floor((a[k] - low_[k]) / edge_)), 0,
                      cubes_[i] - 1);
  }
  const auto& near = walls_near_[cube_index(c)];
  return std::none_of(near.begin(), near.end(),
                      [&](std::uint32_t w) { return crosses(a, b, walls_[w].p); });
}

SidedCage::Place SidedCage::locate(const Vec3& p, const Vec3& into) const {
  const double off = into.norm() > 0 ? kOff * spacing() / into.norm() : 0;
  const Vec3 from = p + off * into;
  Index middle{};
  Index cube{};
  for (int a = 0; a < 3; ++a) {
    const auto k = static_cast<std::size_t>(a);
    const double x = (from[a] - low_[a]) / spacing();
    if (!(x >= 0 && x < cubes_[k] * kSamples)) return {p, -1};
    middle[k] = static_cast<std::int32_t>(x);
    cube[k] = middle[k] / kSamples;
  }
  const std::size_t at = cube_index(cube);
  if (first_[at + 1] - first_[at] == 1 && walls_near_[at].empty()) return {p, first_[at]};
  const Index* nearest = nullptr;
  Index best{};
  Index s{};
  for (const Index& offset : offsets_) {
    for (std::size_t a = 0; a < 3; ++a) s[a] = middle[a] + offset[a];
    if (!is_sample(s) || part_[sample_index(s)] == kNone) continue;
    if (nearest == nullptr) best = s;
    nearest = &offset;
    if (!sees(from, sample_at(s))) continue;
    best = s;
    break;
  }
  if (nearest == nullptr) return {p, kNoCopy};
  Place place{sample_at(best), copy_of(best)};
  carry(place, p);
  return place;
}

/// The copy over a face; of several the one whose tissue is nearest to `p`.
std::int32_t SidedCage::next_of(std::int32_t copy, std::size_t face, const Vec3& p) const noexcept {
  const Copy& from = copies_[static_cast<std::size_t>(copy)];
  if (from.next[face] != kSeveral) return from.next[face];
  Index cube = from.cube;
  cube[face / 2] += face % 2 == 1 ? 1 : -1;
  std::int32_t best = kNoCopy;
  double least = 0;
  Index s{};
  for (s[2] = cube[2] * kSamples; s[2] < (cube[2] + 1) * kSamples; ++s[2])
    for (s[1] = cube[1] * kSamples; s[1] < (cube[1] + 1) * kSamples; ++s[1])
      for (s[0] = cube[0] * kSamples; s[0] < (cube[0] + 1) * kSamples; ++s[0]) {
        const std::int32_t there = copy_of(s);
        if (there < 0) continue;
        const std::int32_t back = copies_[static_cast<std::size_t>(there)].next[face ^ 1U];
        const double distance = (sample_at(s) - p).squaredNorm();
        if ((back != copy && back != kSeveral) || (best >= 0 && distance >= least)) continue;
        best = there;
        least = distance;
      }
  return best;
}

void SidedCage::carry(Place& place, const Vec3& p) const noexcept {
  place.p = p;
  if (place.copy < 0) return;
  const Vec3 x = (p - low_) / edge_;
  const int most = cubes_[0] + cubes_[1] + cubes_[2];
  for (int pass = 0; pass < most; ++pass) {
    const Copy& copy = copies_[static_cast<std::size_t>(place.copy)];
    double farthest = 0;
    std::int32_t next = -1;
    for (std::size_t a = 0; a < 3; ++a) {
      const double u = x[static_cast<int>(a)] - copy.cube[a];
      const double beyond = std::max(-u, u - 1);
      if (beyond <= farthest) continue;
      const std::int32_t there = next_of(place.copy, 2 * a + (u > 0 ? 1 : 0), p);
      if (there < 0) continue;
      farthest = beyond;
      next = there;
    }
    if (next < 0) return;
    place.copy = next;
  }
}

std::array<double, 8> SidedCage::weights(const Place& place) const noexcept {
  const Copy& copy = copies_[static_cast<std::size_t>(place.copy)];
  std::array<double, 3> u{};
  for (std::size_t a = 0; a < 3; ++a) {
    const auto k = static_cast<int>(a);
    u[a] = std::clamp((place.p[k] - low_[k]) / edge_ - copy.cube[a], 0.0, 1.0);
  }
  std::array<double, 8> w{};
  for (std::size_t i = 0; i < 8; ++i)
    w[i] =
        ((i & 1U) ? u[0] : 1 - u[0]) * ((i & 2U) ? u[1] : 1 - u[1]) * ((i & 4U) ? u[2] : 1 - u[2]);
  return w;
}

}  // namespace artus
