// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <algorithm>
#include <array>
#include <functional>

#include "artus/detail/anatomy/body/tet_mesh.h"
#include "artus/detail/anatomy/compile/mesh/tet_topology.h"

namespace artus::test {

/// The cube [0, side]^3 as `n`^3 cells of six tetrahedra each, which all share the cell's diagonal;
/// positive, conforming, without interfaces. `label` gives the region at a tetrahedron's centroid.
inline TetMesh make_cube_of_tets(std::uint32_t n, double side,
                                 const std::function<RegionId(const Vec3&)>& label) {
  TetMesh mesh;
  const auto at = [n](std::uint32_t x, std::uint32_t y, std::uint32_t z) {
    return x + (n + 1) * (y + (n + 1) * z);
  };
  for (std::uint32_t z = 0; z <= n; ++z)
    for (std::uint32_t y = 0; y <= n; ++y)
      for (std::uint32_t x = 0; x <= n; ++x) mesh.vertices.push_back(side / n * Vec3(x, y, z));
  std::array<std::uint32_t, 3> axes{0, 1, 2};
  do {
    for (std::uint32_t z = 0; z < n; ++z)
      for (std::uint32_t y = 0; y < n; ++y)
        for (std::uint32_t x = 0; x < n; ++x) {
          std::array<std::uint32_t, 3> corner{x, y, z};
          std::array<std::uint32_t, 4> tet{at(x, y, z), 0, 0, 0};
          for (std::size_t k = 0; k < 3; ++k) {
            ++corner[axes[k]];
            tet[k + 1] = at(corner[0], corner[1], corner[2]);
          }
          mesh.tetrahedra.push_back(tet);
          mesh.regions.push_back(kFirstRegion);
          if (tet_volume(mesh, mesh.tetrahedra.size() - 1) < 0)
            std::swap(mesh.tetrahedra.back()[2], mesh.tetrahedra.back()[3]);
        }
  } while (std::next_permutation(axes.begin(), axes.end()));
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    Vec3 centre = Vec3::Zero();
    for (const std::uint32_t v : mesh.tetrahedra[t]) centre += mesh.vertices[v] / 4;
    mesh.regions[t] = label(centre);
  }
  return mesh;
}

/// The same with its interfaces; all around is outside.
inline TetMesh make_body_of_tets(std::uint32_t n, double side,
                                 const std::function<RegionId(const Vec3&)>& label) {
  TetMesh mesh = make_cube_of_tets(n, side, label);
  rebuild_interfaces(mesh, *find_tet_neighbours(mesh), [](const Vec3&) { return kOutside; });
  return mesh;
}

}  // namespace artus::test
