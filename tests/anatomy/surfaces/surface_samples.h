// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <numbers>
#include <string>

#include "artus/detail/anatomy/surfaces/surface_mesh.h"
#include "tests/support/paths.h"

namespace artus {

/// An axis-parallel cube around `centre` with half the side `half`, m; closed, wound outward.
inline SurfaceMesh make_cube(const Vec3& centre, double half) {
  SurfaceMesh mesh;
  for (const double z : {-half, half})
    for (const double y : {-half, half})
      for (const double x : {-half, half}) mesh.vertices.push_back(centre + Vec3(x, y, z));
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

/// Puts the faces of `b` behind those of `a`.
inline void append_mesh(SurfaceMesh& a, const SurfaceMesh& b) {
  const auto shift = static_cast<std::uint32_t>(a.vertices.size());
  a.vertices.insert(a.vertices.end(), b.vertices.begin(), b.vertices.end());
  for (const auto& t : b.triangles)
    a.triangles.push_back({t[0] + shift, t[1] + shift, t[2] + shift});
}

/// A sphere as a grid of latitudes and longitudes, volume 0.4 % below the ball's.
inline SurfaceMesh make_sphere(const Vec3& centre, double radius) {
  constexpr std::uint32_t kRows = 40;
  constexpr std::uint32_t kColumns = 80;
  SurfaceMesh mesh;
  for (std::uint32_t i = 1; i < kRows; ++i) {
    for (std::uint32_t j = 0; j < kColumns; ++j) {
      const double theta = std::numbers::pi * i / kRows;
      const double phi = 2 * std::numbers::pi * j / kColumns;
      mesh.vertices.push_back(centre + radius * Vec3(std::sin(theta) * std::cos(phi),
                                                     std::sin(theta) * std::sin(phi),
                                                     std::cos(theta)));
    }
  }
  const auto top = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.push_back(centre + Vec3(0, 0, radius));
  mesh.vertices.push_back(centre - Vec3(0, 0, radius));
  const auto at = [](std::uint32_t i, std::uint32_t j) {
    return i * kColumns + j % kColumns;
  };
  for (std::uint32_t j = 0; j < kColumns; ++j) {
    mesh.triangles.push_back({top, at(0, j), at(0, j + 1)});
    mesh.triangles.push_back({top + 1, at(kRows - 2, j + 1), at(kRows - 2, j)});
    for (std::uint32_t i = 0; i + 2 < kRows; ++i) {
      mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return mesh;
}

/// An open tube of `n` sides around z, radius and length in m.
inline SurfaceMesh make_tube(std::uint32_t n, std::uint32_t rings, double radius, double length) {
  SurfaceMesh mesh;
  for (std::uint32_t r = 0; r < rings; ++r)
    for (std::uint32_t k = 0; k < n; ++k)
      mesh.vertices.emplace_back(radius * std::cos(6.283185307179586 * k / n),
                                 radius * std::sin(6.283185307179586 * k / n),
                                 length * r / (rings - 1));
  for (std::uint32_t r = 0; r + 1 < rings; ++r)
    for (std::uint32_t k = 0; k < n; ++k) {
      const std::uint32_t a = r * n + k;
      const std::uint32_t b = r * n + (k + 1) % n;
      mesh.triangles.push_back({a, b, b + n});
      mesh.triangles.push_back({a, b + n, a + n});
    }
  return mesh;
}

/// The real shoulder's surfaces when they are at hand ($ARTUS_SHARED or ../shared), else empty.
inline std::filesystem::path real_shoulder_folder() {
  const char* shared = std::getenv("ARTUS_SHARED");  // NOLINT(concurrency-mt-unsafe): one thread
  const std::filesystem::path root =
      shared != nullptr ? shared : artus::test::source_dir() / ".." / "shared";
  const auto folder = root / "data" / "shoulder";
  return std::filesystem::is_directory(folder) ? folder : std::filesystem::path{};
}

}  // namespace artus
