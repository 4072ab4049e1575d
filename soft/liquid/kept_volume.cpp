// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/soft/liquid/kept_volume.h"

#include <array>
#include <vector>

namespace artus {
namespace {

/// m^3 within the walls of all these regions, at rest and as tissue has moved them.
struct Held {
  double rest = 0;
  double moved = 0;
};

Held held_in(const TetMesh& mesh, const std::vector<bool>& regions, const DeformedBody& tissue) {
  Held held;
  const Vec3& from = mesh.vertices.front();
  const auto is_in = [&](RegionId r) {
    return r < regions.size() && regions[r];
  };
  for (const Interface& f : mesh.interfaces) {
    if (is_in(f.front) == is_in(f.back)) continue;
    const double sign = is_in(f.back) ? 1 : -1;
    std::array<Vec3, 3> p;
    std::array<Vec3, 3> q;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3& vertex = mesh.vertices[f.vertices[k]];
      p[k] = vertex - from;
      q[k] = p[k] + tissue.displacement(vertex);
    }
    held.rest += sign * p[0].dot(p[1].cross(p[2])) / 6;
    held.moved += sign * q[0].dot(q[1].cross(q[2])) / 6;
  }
  return held;
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
