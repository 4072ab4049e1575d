// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/body/meshed_block.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <vector>

#include "artus/detail/core/check.h"

namespace artus {
namespace {

using Corners = std::array<std::uint32_t, 3>;

/// A face of tetrahedra, with the regions on either side.
struct Face {
  Corners corners{};  ///< normal out of the tetrahedron that named it first
  RegionId inner = kOutside;
  RegionId outer = kOutside;
};

/// Where two regions meet, and where the body ends.
std::vector<Interface> interfaces_of(const TetMesh& mesh) {
  std::map<Corners, Face> faces;
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    const auto& [a, b, c, d] = mesh.tetrahedra[t];
    for (const Corners& corners : {Corners{a, c, b}, {a, b, d}, {a, d, c}, {b, c, d}}) {
      Corners key = corners;
      std::sort(key.begin(), key.end());
      const auto [place, is_new] = faces.try_emplace(key, Face{corners, mesh.regions[t], kOutside});
      if (!is_new) place->second.outer = mesh.regions[t];
    }
  }
  std::vector<Interface> interfaces;
  for (const auto& [key, face] : faces) {
    if (face.inner != face.outer) interfaces.push_back({face.corners, face.outer, face.inner});
  }
  return interfaces;
}

std::vector<double> heights_of(std::span<const FlatLayer> layers, double cell,
                               std::vector<RegionId>& regions) {
  std::vector<double> z{0};
  for (std::size_t i = 0; i < layers.size(); ++i) {
    const int n = std::max(1, static_cast<int>(std::lround(layers[i].thickness / cell)));
    const double top = z.back();
    for (int k = 1; k <= n; ++k) {
      z.push_back(top + layers[i].thickness * k / n);
      regions.push_back(static_cast<RegionId>(kFirstRegion + i));
    }
  }
  return z;
}

}  // namespace

CompiledJoint make_meshed_block(const std::vector<Tissue>& tissues,
                                std::span<const FlatLayer> layers, double width_x, double depth_y,
                                double cell) {
  CompiledJoint joint = make_layered_block(tissues, layers, width_x, depth_y);
  TetMesh mesh;
  std::vector<RegionId> region_at;
  const std::vector<double> z = heights_of(layers, cell, region_at);
  const std::array<std::size_t, 3> n{static_cast<std::size_t>(std::lround(width_x / cell)),
                                     static_cast<std::size_t>(std::lround(depth_y / cell)),
                                     region_at.size()};
  const auto vertex = [&](const std::array<std::size_t, 3>& at) {
    return static_cast<std::uint32_t>(at[0] + (n[0] + 1) * (at[1] + (n[1] + 1) * at[2]));
  };
  const auto place = [](std::size_t i, std::size_t of, double width) {
    return width * (static_cast<double>(i) / static_cast<double>(of) - 0.5);
  };
  for (std::size_t k = 0; k <= n[2]; ++k)
    for (std::size_t j = 0; j <= n[1]; ++j)
      for (std::size_t i = 0; i <= n[0]; ++i)
        mesh.vertices.emplace_back(place(i, n[0], width_x), place(j, n[1], depth_y), z[k]);
  const auto divide = [&](const std::array<std::size_t, 3>& low) {
    std::array<std::size_t, 3> axes{0, 1, 2};
    do {
      std::array<std::uint32_t, 4> tet{};
      std::array<std::size_t, 3> at = low;
      tet[0] = vertex(at);
      for (std::size_t s = 0; s < 3; ++s) {
        ++at[axes[s]];
        tet[s + 1] = vertex(at);
      }
      mesh.tetrahedra.push_back(tet);
      mesh.regions.push_back(region_at[low[2]]);
      if (tet_volume(mesh, mesh.tetrahedra.size() - 1) < 0)
        std::swap(mesh.tetrahedra.back()[2], mesh.tetrahedra.back()[3]);
    } while (std::next_permutation(axes.begin(), axes.end()));
  };
  for (std::size_t k = 0; k < n[2]; ++k)
    for (std::size_t j = 0; j < n[1]; ++j)
      for (std::size_t i = 0; i < n[0]; ++i) divide({i, j, k});
  mesh.interfaces = interfaces_of(mesh);
  joint.mesh = std::move(mesh);
  return joint;
}

void stand_on_table(CompiledJoint& block) {
  TetMesh& mesh = block.mesh;
  ARTUS_REQUIRE(!mesh.tetrahedra.empty(), "the block must be meshed");
  double bottom = 0;
  for (const Vec3& v : mesh.vertices) bottom = std::max(bottom, v.z());
  for (Interface& face : mesh.interfaces) {
    const bool low = std::all_of(face.vertices.begin(), face.vertices.end(), [&](std::uint32_t v) {
      return mesh.vertices[v].z() > bottom - 1e-9;
    });
    if (!low) continue;
    if (face.front == kOutside) face.front = kBeyond;
    if (face.back == kOutside) face.back = kBeyond;
  }
}

void add_meshed_ball(CompiledJoint& block, const Ball& ball, RegionId within, int subdivisions) {
  add_ball(block, ball, within, subdivisions);
  const auto inside = static_cast<RegionId>(block.regions.size() - 1);
  TetMesh& mesh = block.mesh;
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    Vec3 middle = Vec3::Zero();
    for (const std::uint32_t corner : mesh.tetrahedra[t]) middle += mesh.vertices[corner] / 4;
    if (mesh.regions[t] == within && (middle - ball.centre).norm() < ball.radius)
      mesh.regions[t] = inside;
  }
}

}  // namespace artus
