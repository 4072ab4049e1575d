// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/devices/kit/solid.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <numeric>
#include <utility>
#include <vector>

#include "artus/detail/core/check.h"

namespace artus::kit {
namespace {

using Point = Eigen::Vector2d;
using Outline = std::vector<Point>;  // counterclockwise

double cross(const Point& a, const Point& b, const Point& c) {
  return (b - a).x() * (c - a).y() - (b - a).y() * (c - a).x();
}

bool is_ear(const Outline& outline, const std::vector<std::uint32_t>& left, std::size_t at) {
  const std::size_t n = left.size();
  const auto point = [&](std::size_t i) {
    return outline[left[i % n]];
  };
  const Point a = point(at + n - 1);
  const Point b = point(at);
  const Point c = point(at + 1);
  if (cross(a, b, c) <= 0) return false;
  for (std::size_t i = 0; i < n; ++i) {
    const Point p = point(i);
    if (p == a || p == b || p == c) continue;
    if (cross(a, b, p) >= 0 && cross(b, c, p) >= 0 && cross(c, a, p) >= 0) return false;
  }
  return true;
}

/// The outline cut into triangles by its ears, its own vertices alone.
std::vector<Triangle> cut(const Outline& outline) {
  std::vector<std::uint32_t> left(outline.size());
  std::iota(left.begin(), left.end(), 0U);
  std::vector<Triangle> triangles;
  while (left.size() > 3) {
    const std::size_t n = left.size();
    std::size_t at = 0;
    while (at < n && !is_ear(outline, left, at)) ++at;
    ARTUS_ASSERT(at < n);
    triangles.push_back({left[(at + n - 1) % n], left[at], left[(at + 1) % n]});
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(at));
  }
  triangles.push_back({left[0], left[1], left[2]});
  return triangles;
}

/// Sections of as many points each, one above the other by z, joined; the ends closed.
SurfaceMesh loft(const std::vector<Outline>& sections, const std::vector<double>& z) {
  SurfaceMesh solid;
  const auto n = static_cast<std::uint32_t>(sections.front().size());
  for (std::size_t k = 0; k < sections.size(); ++k)
    for (const Point& p : sections[k]) solid.vertices.emplace_back(p.x(), p.y(), z[k]);
  for (const auto& [a, b, c] : cut(sections.front())) solid.triangles.push_back({a, c, b});
  const std::uint32_t top = n * static_cast<std::uint32_t>(sections.size() - 1);
  for (const auto& [a, b, c] : cut(sections.back()))
    solid.triangles.push_back({top + a, top + b, top + c});
  for (std::uint32_t k = 0; k < top; k += n)
    for (std::uint32_t i = 0; i < n; ++i) {
      const std::uint32_t next = (i + 1) % n;
      solid.triangles.push_back({k + i, k + next, k + n + next});
      solid.triangles.push_back({k + i, k + n + next, k + n + i});
    }
  return solid;
}

/// The four corners of the half hexagon, from the right to the left: counterclockwise.
Outline front_of(const PrismSize& size) {
  const double x = size.face / 2 + size.face * std::cos(kFaceTurn);
  const double y = -size.face * std::sin(kFaceTurn);
  return {{x, y}, {size.face / 2, 0}, {-size.face / 2, 0}, {-x, y}};
}

/// The same for the other hand.
void mirror(SurfaceMesh& mesh) {
  for (Vec3& vertex : mesh.vertices) vertex.x() = -vertex.x();
  for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
}

Outline rectangle(double x0, double x1, double y0, double y1) {
  return {{x1, y1}, {x0, y1}, {x0, y0}, {x1, y0}};
}

}  // namespace

SurfaceMesh make_syringe_clip(double barrel) {
  ARTUS_REQUIRE(barrel >= 8e-3 && barrel <= 22e-3, "a barrel of 8 to 22 mm");
  constexpr double kWall = 3e-3;  // m behind the barrel
  constexpr double kOpen = 0.87;  // rad, half of the slot's opening
  constexpr int kArc = 36;        // points around the barrel
  const double r = barrel / 2;
  const Point axis(0, nominal_needle().translation().y());
  const double back = axis.y() - r * std::cos(kOpen);
  Outline outline = front_of(kSyringePrism);
  outline.emplace_back(-r - kWall, back);
  for (int i = 0; i <= kArc; ++i) {  // around the barrel, from the left edge of the slot
    const double angle = -kOpen - i * (2 * std::numbers::pi - 2 * kOpen) / kArc;
    outline.emplace_back(axis + r * Point(std::sin(angle), -std::cos(angle)));
  }
  outline.emplace_back(r + kWall, back);
  const double half = kSyringePrism.length / 2;
  return loft({outline, outline}, {-half, half});
}

SurfaceMesh make_probe_mock(Hand hand) {
  constexpr double kBack = -30e-3;  // m
  Outline prism = front_of(kProbePrism);
  prism.emplace_back(prism[3].x(), kBack);
  prism.emplace_back(prism[0].x(), kBack);
  const Pose X_BP = nominal_face(Hand::right);
  const double x = kFaceLength / 2;
  const double y = kFaceWidth / 2;
  Outline face;
  for (const Vec3& p : {Vec3(x, y, 0), Vec3(x / 3, y, 0), Vec3(-x / 3, y, 0), Vec3(-x, y, 0),
                        Vec3(-x, -y, 0), Vec3(x, -y, 0)})
    face.emplace_back((X_BP * p).head<2>());
  const double half = kProbePrism.length / 2;
  SurfaceMesh mock = loft({prism, prism, face}, {-half, half, X_BP.translation().z()});
  if (hand == Hand::left) mirror(mock);
  return mock;
}

SurfaceMesh make_plunger_flag(Hand hand) {
  constexpr double kPlate = 8e-3;  // m, half of the plate
  constexpr double kThick = 3e-3;  // m
  const Marker marker = make_plunger_marker(hand);
  const Vec3 c = marker.centre();
  const double outer = std::abs(c.x()) + kPlate;
  const Outline plate = rectangle(hand == Hand::right ? -kPlate : -outer,
                                  hand == Hand::right ? outer : kPlate, c.y() - kThick, c.y());
  return loft({plate, plate}, {c.z() - kPlate, c.z() + kPlate});
}

SurfaceMesh make_divot_plate() {
  constexpr std::array<double, 6> kX{-40e-3, -33e-3, -27e-3, 27e-3, 33e-3, 40e-3};  // m
  constexpr std::array<double, 4> kY{-10e-3, -3e-3, 3e-3, 10e-3};                   // m
  constexpr double kThick = 6e-3;                                                   // m
  constexpr double kPit = 3e-3;                                                     // m deep
  constexpr std::uint32_t kNx = kX.size();
  constexpr std::uint32_t kNy = kY.size();
  SurfaceMesh solid;
  for (const double z : {0.0, -kThick})
    for (const double y : kY)
      for (const double x : kX) solid.vertices.emplace_back(x, y, z);
  const auto at = [](std::uint32_t layer, std::uint32_t i, std::uint32_t j) {
    return (layer * kNy + j) * kNx + i;
  };
  const auto quad = [&solid](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    solid.triangles.push_back({a, b, c});
    solid.triangles.push_back({a, c, d});
  };
  for (std::uint32_t j = 0; j + 1 < kNy; ++j)
    for (std::uint32_t i = 0; i + 1 < kNx; ++i) {
      const std::array<std::uint32_t, 4> top{at(0, i, j), at(0, i + 1, j), at(0, i + 1, j + 1),
                                             at(0, i, j + 1)};
      quad(at(1, i, j), at(1, i, j + 1), at(1, i + 1, j + 1), at(1, i + 1, j));
      if (j == 1 && (i == 1 || i == 3)) {
        const auto apex = static_cast<std::uint32_t>(solid.vertices.size());
        solid.vertices.emplace_back(i == 1 ? -kDivotsApart / 2 : kDivotsApart / 2, 0, -kPit);
        for (std::size_t k = 0; k < 4; ++k)
          solid.triangles.push_back({top[k], top[(k + 1) % 4], apex});
      } else {
        quad(top[0], top[1], top[2], top[3]);
      }
    }
  for (std::uint32_t i = 0; i + 1 < kNx; ++i) {
    quad(at(1, i, 0), at(1, i + 1, 0), at(0, i + 1, 0), at(0, i, 0));
    quad(at(1, i + 1, kNy - 1), at(1, i, kNy - 1), at(0, i, kNy - 1), at(0, i + 1, kNy - 1));
  }
  for (std::uint32_t j = 0; j + 1 < kNy; ++j) {
    quad(at(1, 0, j + 1), at(1, 0, j), at(0, 0, j), at(0, 0, j + 1));
    quad(at(1, kNx - 1, j), at(1, kNx - 1, j + 1), at(0, kNx - 1, j + 1), at(0, kNx - 1, j));
  }
  return solid;
}

}  // namespace artus::kit
