// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/haptics/probe/skin_surface.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace artus {
namespace {

constexpr double kBeside = 10e-3;  // m beyond the face's rim
constexpr double kReach = 60e-3;   // m before and behind the face
constexpr double kMaxSlope = 1;
constexpr double kNoHeight = std::numeric_limits<double>::infinity();

constexpr auto kColumns = static_cast<int>(ProbePacket::kColumns);
constexpr auto kRows = static_cast<int>(ProbePacket::kRows);

using Heights = std::array<double, ProbePacket::kColumns * ProbePacket::kRows>;

double& at(Heights& z, int i, int j) {
  return z[static_cast<std::size_t>(i + kColumns * j)];
}

/// Looks for the lines of the grid that a triangle is met by; keeps the height nearest to outside.
void raster(const std::array<Vec3, 3>& corners, double spacing_x, double spacing_y, Heights& z) {
  const auto& [a, b, c] = corners;
  const double area = (b - a).cross(c - a).z();
  if (!(area < 0)) return;  // turned away from the face
  const Vec3 low = a.cwiseMin(b).cwiseMin(c);
  const Vec3 high = a.cwiseMax(b).cwiseMax(c);
  const auto first = [](double p, double spacing, int n) {
    return std::max(0, static_cast<int>(std::ceil(p / spacing + 0.5 * (n - 1) - 1e-9)));
  };
  const auto last = [](double p, double spacing, int n) {
    return std::min(n - 1, static_cast<int>(std::floor(p / spacing + 0.5 * (n - 1) + 1e-9)));
  };
  for (int j = first(low.y(), spacing_y, kRows); j <= last(high.y(), spacing_y, kRows); ++j) {
    for (int i = first(low.x(), spacing_x, kColumns); i <= last(high.x(), spacing_x, kColumns);
         ++i) {
      const double x = (i - 0.5 * (kColumns - 1)) * spacing_x;
      const double y = (j - 0.5 * (kRows - 1)) * spacing_y;
      const auto turn = [x, y](const Vec3& s, const Vec3& t) {
        return (s.x() - x) * (t.y() - y) - (s.y() - y) * (t.x() - x);
      };
      const Vec3 w = Vec3(turn(b, c), turn(c, a), turn(a, b)) / area;
      if (w.minCoeff() < -1e-9) continue;
      double& height = at(z, i, j);
      height = std::min(height, w.x() * a.z() + w.y() * b.z() + w.z() * c.z());
    }
  }
}

/// Calls `visit(i, j, i_next, j_next)` with each pair of neighbours, there and back.
template <class Visit>
void for_neighbours(Visit visit) {
  for (int j = 0; j < kRows; ++j) {
    for (int i = 0; i < kColumns; ++i) {
      if (i + 1 < kColumns) visit(i, j, i + 1, j);
      if (j + 1 < kRows) visit(i, j, i, j + 1);
    }
  }
  for (int j = kRows; j-- > 0;) {
    for (int i = kColumns; i-- > 0;) {
      if (i > 0) visit(i, j, i - 1, j);
      if (j > 0) visit(i, j, i, j - 1);
    }
  }
}

/// Skin where there was none, from the neighbours that have some. False: there is none at all.
bool fill(Heights& z) {
  for (int pass = 0; pass < kColumns + kRows; ++pass) {
    bool whole = true;
    for_neighbours([&](int i, int j, int k, int l) {
      double& next = at(z, k, l);
      if (std::isinf(next)) next = at(z, i, j);
      whole = whole && !std::isinf(next);
    });
    if (whole) return true;
  }
  return std::none_of(z.begin(), z.end(), [](double h) { return std::isinf(h); });
}

/// Skin that falls away from the face more steeply than kMaxSlope is taken to go on at that slope:
/// a cliff would push a face aside. The smaller height is the outer one.
void limit_slopes(double spacing_x, double spacing_y, Heights& z) {
  for (int pass = 0; pass < 2; ++pass) {
    for_neighbours([&](int i, int j, int k, int l) {
      const double spacing = i == k ? spacing_y : spacing_x;
      at(z, k, l) = std::min(at(z, k, l), at(z, i, j) + kMaxSlope * spacing);
    });
  }
}

}  // namespace

SkinSurface::SkinSurface(const CompiledJoint& joint) : joint_(&joint) {
  for (const Interface& i : joint.mesh.interfaces) {
    if (i.front != kOutside && i.back != kOutside) continue;
    if (i.front == kBeyond || i.back == kBeyond) continue;
    triangles_.push_back(i.vertices);
    if (i.back == kOutside) std::swap(triangles_.back()[1], triangles_.back()[2]);
  }
}

void SkinSurface::describe(const Pose& X_JP, double length, double width,
                           const SoftBody::RestOf& rest_of, ProbePacket& packet) const {
  for (Eigen::Index i = 0; i < 12; ++i)
    packet.X_JF[static_cast<std::size_t>(i)] = X_JP.matrix()(i / 4, i % 4);
  packet.length = length;
  packet.width = width;
  packet.spacing_x = (length + 2 * kBeside) / (kColumns - 1);
  packet.spacing_y = (width + 2 * kBeside) / (kRows - 1);
  packet.z.fill(kNoHeight);
  const Pose X_PJ = X_JP.inverse();
  const double far = 0.5 * std::hypot(length, width) + kBeside + kReach;
  const auto& vertices = joint_->mesh.vertices;
  for (const auto& triangle : triangles_) {
    if ((vertices[triangle[0]] - X_JP.translation()).squaredNorm() > far * far) continue;
    std::array<Vec3, 3> corners;
    for (std::size_t k = 0; k < 3; ++k)
      corners[k] = X_PJ * (rest_of ? rest_of(triangle[k]) : vertices[triangle[k]]);
    if (std::abs(corners[0].z()) > kReach) continue;
    raster(corners, packet.spacing_x, packet.spacing_y, packet.z);
  }
  if (!fill(packet.z)) {
    packet.z.fill(0);
    packet.spacing_x = packet.spacing_y = 0;
    return;
  }
  limit_slopes(packet.spacing_x, packet.spacing_y, packet.z);
}

}  // namespace artus
