// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/soft/liquid/kept_volume.h"

#include <vector>

#include "artus/detail/soft/liquid/space_walls.h"

namespace artus {
namespace {

/// m^3 within the walls of all these regions, at rest and as tissue has moved them.
struct Held {
  double rest = 0;
  double moved = 0;
};

Held held_in(const TetMesh& mesh, const std::vector<bool>& regions, const DeformedBody& tissue) {
  const std::vector<WallTriangle> walls = walls_of(mesh, regions);
  std::vector<Vec3> rest(mesh.vertices.size());  // from the first, so that less is lost
  std::vector<Vec3> moved(mesh.vertices.size());
  std::vector<bool> known(mesh.vertices.size(), false);
  for (const WallTriangle& wall : walls)
    for (const std::uint32_t v : wall) {
      if (known[v]) continue;
      known[v] = true;
      rest[v] = mesh.vertices[v] - mesh.vertices.front();
      moved[v] = rest[v] + tissue.displacement(mesh.vertices[v]);
    }
  return {volume_within(walls, rest, Vec3::Zero()), volume_within(walls, moved, Vec3::Zero())};
}

}  // namespace

double kept_volume(const CompiledJoint& shape, const CompiledJoint& rest,
                   const DeformedBody& tissue) {
  std::vector<bool> filled;
  for (std::size_t r = 0; r < rest.regions.size(); ++r)
    filled.push_back(shape.regions[r].tissue != rest.regions[r].tissue);
  filled.resize(shape.regions.size(), true);  // what parts tissue is a region more
  const Held with = held_in(shape.mesh, filled, tissue);
  const Held without = held_in(rest.mesh, filled, tissue);
  const double given = with.rest - without.rest;
  return given > 0 ? (with.moved - without.moved) / given : 1;
}

}  // namespace artus
