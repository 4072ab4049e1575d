// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/soft/parted_sheet.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Dense>

namespace artus {
namespace {

constexpr int kSide = 56;  // cells to either side of the tip
constexpr int kAcross = 2 * kSide + 1;
constexpr double kSheetCell = 1e-3;  // m
constexpr double kFilmOf = 0.3e-3;   // m of tissue above and below
constexpr double kFilmShare = 0.3;   // of a layer that is thinner than three films
constexpr double kOnEdge = 1e-9;     // of a triangle's side
constexpr double kLongFit =
    20e-3;  // m around the tip, along the fibres, that heights are fitted to
constexpr double kWideFit = 14e-3;    // m beside them
constexpr double kWallsCount = 0.02;  // against fibres, where both are known
constexpr double kNearby = 12e-3;     // m from the tip, where a height counts a third
constexpr double kTangentOver =
    1e-2;  // m over which a wrong slope counts as much as a wrong height

std::size_t cell_at(int i, int j) {
  return static_cast<std::size_t>((j + kSide) * kAcross + i + kSide);
}

int cell_near(double x) {
  return static_cast<int>(std::lround(x / kSheetCell));
}

/// Height of a triangle over (x, y), where it is.
bool height_over(const std::array<Vec3, 3>& t, double x, double y, double& z) {
  const Vec3 ab = t[1] - t[0];
  const Vec3 ac = t[2] - t[0];
  const double det = ab.x() * ac.y() - ab.y() * ac.x();
  if (det == 0) return false;
  const double px = x - t[0].x();
  const double py = y - t[0].y();
  const double u = (px * ac.y() - py * ac.x()) / det;
  const double v = (ab.x() * py - ab.y() * px) / det;
  if (u < -kOnEdge || v < -kOnEdge || u + v > 1 + kOnEdge) return false;
  z = t[0].z() + u * ab.z() + v * ac.z();
  return true;
}

}  // namespace

PartedSheet::PartedSheet(const CompiledJoint& joint, RegionId region, const Vec3& tip,
                         const Eigen::Matrix3d& axes, const FibreField& fibres)
    : region_(region), tip_(tip), axes_(axes), fibres_(&fibres) {
  std::vector<Wall> walls;
  for (const Interface& f : joint.mesh.interfaces) {
    if ((f.front == region) == (f.back == region)) continue;
    Wall wall;
    for (std::size_t k = 0; k < 3; ++k)
      wall.corners[k] = axes.transpose() * (joint.mesh.vertices[f.vertices[k]] - tip);
    const auto& [a, b, c] = wall.corners;
    wall.is_top = ((b - a).cross(c - a).z() > 0) == (f.back == region);
    walls.push_back(wall);
  }
  find_spans(walls);
  fit_height();
}

/// Where lines along the height are inside the region, as far as that goes on from the tip.
void PartedSheet::find_spans(const std::vector<Wall>& walls) {
  struct Hit {
    double z;
    bool is_top;
  };
  const auto n = static_cast<std::size_t>(kAcross * kAcross);
  std::vector<std::vector<Hit>> hits(n);
  for (const Wall& wall : walls) {
    const auto& [a, b, c] = wall.corners;
    const Vec3 low = a.cwiseMin(b).cwiseMin(c) / kSheetCell;
    const Vec3 high = a.cwiseMax(b).cwiseMax(c) / kSheetCell;
    const Vec3 most = Vec3::Constant(kSide);
    const Vec3 from = low.cwiseMax(-most);
    const Vec3 to = high.cwiseMin(most);
    for (int j = static_cast<int>(std::ceil(from.y())); j <= to.y(); ++j)
      for (int i = static_cast<int>(std::ceil(from.x())); i <= to.x(); ++i) {
        double z = 0;
        if (height_over(wall.corners, i * kSheetCell, j * kSheetCell, z))
          hits[cell_at(i, j)].push_back({z, wall.is_top});
      }
  }
  spans_.assign(n, Span{});
  std::vector<std::pair<int, int>> reached;
  const auto take = [&](int i, int j, const Span& from) {
    std::vector<Hit>& here = hits[cell_at(i, j)];
    std::sort(here.begin(), here.end(), [](const Hit& x, const Hit& y) { return x.z < y.z; });
    double most = -1;  // m that it overlaps
    for (std::size_t k = 0; k + 1 < here.size(); ++k) {
      if (here[k].is_top || !here[k + 1].is_top) continue;
      const double shared = std::min(here[k + 1].z, from.high) - std::max(here[k].z, from.low);
      if (shared < 0 || shared <= most) continue;
      most = shared;
      spans_[cell_at(i, j)] = {here[k].z, here[k + 1].z};
    }
    if (most >= 0) reached.emplace_back(i, j);
  };
  take(0, 0, {0, 0});
  for (std::size_t k = 0; k < reached.size(); ++k) {
    const auto [i, j] = reached[k];
    const Span here = spans_[cell_at(i, j)];
    for (const auto& [di, dj] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
      const int x = i + di;
      const int y = j + dj;
      if (std::abs(x) > kSide || std::abs(y) > kSide || spans_[cell_at(x, y)].is_there()) continue;
      take(x, y, here);
    }
  }
}

/// A surface of second order through the tip, by least squares.
void PartedSheet::fit_height() {
  constexpr int kStep = 2;
  constexpr double kStiff = 1e-8;  // m^4, keeps a bend small that few samples tell
  constexpr double kLevel = 1e-4;  // m^2, the same of a slope
  constexpr double kLeast = 0.3;   // of a fibre, in the sheet's first two axes
  using Row = Eigen::Matrix<double, 5, 1>;
  Eigen::Matrix<double, 5, 5> normal = Eigen::Matrix<double, 5, 5>::Zero();
  Row right = Row::Zero();
  const auto ask = [&](const Row& row, double value, double weight) {
    normal += weight * row * row.transpose();
    right += weight * value * row;
  };
  const Span& own = spans_[cell_at(0, 0)];
  if (!own.is_there()) return;
  const double share = std::clamp(-own.low / (own.high - own.low), 0.2, 0.8);
  const double at_tip = own.low + share * (own.high - own.low);
  for (int j = -cell_near(kWideFit); j <= cell_near(kWideFit); j += kStep) {
    for (int i = -cell_near(kLongFit); i <= cell_near(kLongFit); i += kStep) {
      const Span& span = spans_[cell_at(i, j)];
      if (!span.is_there()) continue;
      const double x = i * kSheetCell;
      const double y = j * kSheetCell;
      const double level = span.low + share * (span.high - span.low) - at_tip;
      Vec3 fibre = Vec3::Zero();
      if (*fibres_)
        fibre = axes_.transpose() * (*fibres_)(region_, tip_ + axes_ * Vec3(x, y, level));
      const double flat = fibre.head<2>().norm();
      Row row;
      row << x, y, x * x / 2, y * y / 2, x * y;
      const double near = std::exp(-(x * x + y * y) / (kNearby * kNearby));
      ask(row, level, near * (flat > kLeast ? kWallsCount : 1));
      if (!(flat > kLeast)) continue;
      const double u = kTangentOver * fibre.x() / flat;
      const double v = kTangentOver * fibre.y() / flat;
      row << u, v, u * x, v * y, u * y + v * x;
      ask(row, kTangentOver * fibre.z() / flat, near);
    }
  }
  normal.diagonal() += (Row() << kLevel, kLevel, kStiff, kStiff, kStiff).finished();
  const Row found = normal.ldlt().solve(right);
  slope_ = found.head<2>();
  bend_ << found[2], found[4], found[4], found[3];
}

double PartedSheet::height(const Eigen::Vector2d& p) const {
  return slope_.dot(p) + p.dot(bend_ * p) / 2;
}

Eigen::Vector2d PartedSheet::slope(const Eigen::Vector2d& p) const {
  return slope_ + bend_ * p;
}

const PartedSheet::Span& PartedSheet::span_at(const Eigen::Vector2d& p) const {
  return spans_[cell_at(std::clamp(cell_near(p.x()), -kSide, kSide),
                        std::clamp(cell_near(p.y()), -kSide, kSide))];
}

bool PartedSheet::allows(const Eigen::Vector2d& p, double level) const {
  if (p.cwiseAbs().maxCoeff() > kSide * kSheetCell) return false;
  const Span& span = span_at(p);
  if (!span.is_there()) return false;
  const double film = std::min(kFilmOf, kFilmShare * (span.high - span.low));
  const double z = height(p) + level;
  return z >= span.low + film && z <= span.high - film;
}

double PartedSheet::nearest_level(double level) const {
  const Span& span = span_at(Eigen::Vector2d::Zero());
  if (!span.is_there()) return level;
  const double film = std::min(kFilmOf, kFilmShare * (span.high - span.low));
  return std::clamp(level, span.low + film, span.high - film);
}

Eigen::Vector2d PartedSheet::along(const Eigen::Vector2d& p, double level) const {
  if (!*fibres_) return Eigen::Vector2d::UnitX();
  const Vec3 fibre = axes_.transpose() * (*fibres_)(region_, point(p, level));
  const Eigen::Vector2d flat = fibre.head<2>();
  if (!(flat.norm() > 0.1)) return Eigen::Vector2d::UnitX();
  return (flat.x() < 0 ? -1 : 1) * flat.normalized();
}

Vec3 PartedSheet::point(const Eigen::Vector2d& p, double level) const {
  return tip_ + axes_ * Vec3(p.x(), p.y(), height(p) + level);
}

}  // namespace artus
