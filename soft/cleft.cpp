// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/soft/cleft.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace artus {
namespace {

constexpr double kBoneNear = 60e-3;  // m around a bolus within which bone matters
constexpr double kNode = 1e-3;       // m between nodes of a map
constexpr double kHeld = 3e-3;       // m beside bone over which the plate is held
constexpr double kSpread = 10e-3;    // m, at least
constexpr double kAsItIs = 10e-3;  // m above and below that are moved as they are, and other clefts
                                   // in them
constexpr double kOwnFilm = 20e-6;  // m, half, by which the liquid's own walls are apart under bone
constexpr double kSteepest = 1.54;  // of the held plate's rise, a held length from bone
constexpr double kHigh = 5e-3;      // m of height that count as one beside a bolus

/// By how much what is `z` m from the sheet is wider than there.
double wider(double z, double spread) {
  return 1 + std::max(0.0, std::abs(z) - kAsItIs) / spread;
}

/// Of a plate held along a rim, at `x` m from there.
double held(double x) {
  const double part = std::clamp(x / kHeld, 0.0, 1.0);
  return part * part * (2 - part) * (2 - part);
}

}  // namespace

std::vector<Vec3> find_bone_points(const CompiledJoint& joint, const Vec3& around) {
  constexpr int kMost = 100;  // pieces of a triangle's side
  std::vector<Vec3> points;
  for (const Interface& f : joint.mesh.interfaces) {
    if (!joint.tissue_of(f.front).haptic.hard && !joint.tissue_of(f.back).haptic.hard) continue;
    const Vec3& a = joint.mesh.vertices[f.vertices[0]];
    const Vec3 ab = joint.mesh.vertices[f.vertices[1]] - a;
    const Vec3 ac = joint.mesh.vertices[f.vertices[2]] - a;
    const double longest = std::max({ab.norm(), ac.norm(), (ac - ab).norm()});
    if ((a - around).norm() > kBoneNear + longest) continue;
    const int n = std::clamp(static_cast<int>(std::ceil(longest / kNode)), 1, kMost);
    for (int i = 0; i <= n; ++i)
      for (int j = 0; i + j <= n; ++j) points.push_back(a + (ab * i + ac * j) / n);
  }
  return points;
}

Cleft::Cleft(const Bolus& bolus, std::span<const Vec3> bone) : bolus_(bolus) {
  const double ball = 4 * std::numbers::pi / 3;
  half_ = std::cbrt(bolus.volume / (ball * bolus.proportion.prod())) * bolus.proportion;
  opening_ = 2 * half_.z();
  // Twice what keeps the order of all that lies above each other, however bone cuts the outline.
  const double widest = half_.head<2>().maxCoeff();
  spread_ = std::max(kSpread, 2 * opening_ * (2 + kSteepest * widest / kHeld));
  nodes_x_ = static_cast<int>(std::ceil(half_.x() / kNode)) + 2;
  nodes_y_ = static_cast<int>(std::ceil(half_.y() / kNode)) + 2;
  sides_[0].part = 1 - bolus.up;
  sides_[1].part = bolus.up;
  for (const Vec3& point : bone) {
    Vec3 p = bolus_.axes.transpose() * (point - bolus_.centre);
    p.z() -= sheet(p.x(), p.y());
    const double together = 1 / wider(p.z(), spread_);
    mark(sides_[p.z() >= 0 ? 1 : 0], together * p.x(), together * p.y());
  }
  for (Side& side : sides_) finish(side);
}

/// Bone lies over (x, y): all four nodes that are read there.
void Cleft::mark(Side& side, double x, double y) const {
  const int i = static_cast<int>(std::floor(x / kNode)) + nodes_x_;
  const int j = static_cast<int>(std::floor(y / kNode)) + nodes_y_;
  const int across = 2 * nodes_x_ + 1;
  if (i < 0 || j < 0 || i >= 2 * nodes_x_ || j >= 2 * nodes_y_) return;
  if (side.room.empty())
    side.room.assign(static_cast<std::size_t>(across * (2 * nodes_y_ + 1)), kHeld);
  for (const int k :
       {j * across + i, j * across + i + 1, (j + 1) * across + i, (j + 1) * across + i + 1})
    side.room[static_cast<std::size_t>(k)] = 0;
}

/// From marks to how far each node is from one, and what is left of the opening.
void Cleft::finish(Side& side) const {
  if (side.room.empty()) return;
  const int across = 2 * nodes_x_ + 1;
  const int down = 2 * nodes_y_ + 1;
  const int reach = static_cast<int>(std::ceil(kHeld / kNode));
  const std::vector<double> marks = side.room;
  double all = 0;
  double left = 0;
  for (int j = 0; j < down; ++j) {
    for (int i = 0; i < across; ++i) {
      double nearest = kHeld;
      for (int y = std::max(0, j - reach); y <= std::min(down - 1, j + reach); ++y)
        for (int x = std::max(0, i - reach); x <= std::min(across - 1, i + reach); ++x)
          if (marks[static_cast<std::size_t>(y * across + x)] == 0)
            nearest = std::min(nearest, kNode * std::hypot(x - i, y - j));
      side.room[static_cast<std::size_t>(j * across + i)] = nearest;
      const double u = (i - nodes_x_) * kNode / half_.x();
      const double v = (j - nodes_y_) * kNode / half_.y();
      const double open = std::sqrt(std::max(0.0, 1 - u * u - v * v));
      all += open;
      left += open * held(nearest);
    }
  }
  side.free = all > 0 ? left / all : 1;
}

double Cleft::sheet(double x, double y) const {
  const Eigen::Vector2d p(x, y);
  return bolus_.slope.dot(p) + p.dot(bolus_.bend * p) / 2;
}

/// m by which a side opens at (x, y) of the sheet.
double Cleft::open_at(const Side& side, double x, double y) const {
  const double u = x / half_.x();
  const double v = y / half_.y();
  const double left = 1 - u * u - v * v;
  if (!(left > 0)) return 0;
  const double open = side.part * opening_ * std::sqrt(left);
  if (side.room.empty()) return open;
  const double s = x / kNode + nodes_x_;
  const double t = y / kNode + nodes_y_;
  const auto i = static_cast<int>(std::floor(s));
  const auto j = static_cast<int>(std::floor(t));
  const double fs = s - i;
  const double ft = t - j;
  const auto room = [&](int x_node, int y_node) {
    return side.room[static_cast<std::size_t>(y_node * (2 * nodes_x_ + 1) + x_node)];
  };
  return open * held((1 - ft) * ((1 - fs) * room(i, j) + fs * room(i + 1, j)) +
                     ft * ((1 - fs) * room(i, j + 1) + fs * room(i + 1, j + 1)));
}

Vec3 Cleft::moved(const Vec3& p) const {
  const Vec3 at = bolus_.axes.transpose() * (p - bolus_.centre);
  const double z = at.z() - sheet(at.x(), at.y());
  const double together = 1 / wider(z, spread_);
  const bool up = z >= 0;
  const double lift =
      together * together * open_at(sides_[up ? 1 : 0], together * at.x(), together * at.y());
  return p + (up ? lift : -lift) * bolus_.axes.col(2);
}

Vec3 Cleft::wall(const Vec3& unit) const {
  const double x = half_.x() * unit.x();
  const double y = half_.y() * unit.y();
  const double open = open_at(sides_[unit.z() >= 0 ? 1 : 0], x, y);
  const double z = (unit.z() >= 0 ? open : -open) + kOwnFilm * unit.z();
  return bolus_.centre + bolus_.axes * Vec3(x, y, sheet(x, y) + z);
}

Vec3 Cleft::local(const Vec3& p) const {
  const Vec3 at = bolus_.axes.transpose() * (p - bolus_.centre);
  return {at.x() / half_.x(), at.y() / half_.y(),
          (at.z() - sheet(at.x(), at.y())) / std::max(half_.z(), kHigh)};
}

}  // namespace artus
