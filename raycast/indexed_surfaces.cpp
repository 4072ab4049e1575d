// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/raycast/indexed_surfaces.h"

#include <algorithm>
#include <limits>
#include <map>
#include <numeric>

#include <Eigen/Geometry>

#include "artus/detail/core/check.h"

namespace artus {
namespace {

void check_interface(const Interface& interface, std::span<const Vec3> vertices) {
  ARTUS_REQUIRE(interface.front != interface.back, "an interface has one region on both sides");
  for (const std::uint32_t v : interface.vertices) {
    ARTUS_REQUIRE(v < vertices.size(), "vertex index out of range");
    ARTUS_REQUIRE(vertices[v].allFinite(), "a vertex is not finite");
  }
}

/// The middle of the box around all interfaces, m; refuses what is no interface.
Vec3 find_centre(std::span<const Vec3> vertices, std::span<const Interface> interfaces) {
  Eigen::AlignedBox3d box;
  for (const Interface& interface : interfaces) {
    check_interface(interface, vertices);
    for (const std::uint32_t v : interface.vertices) box.extend(vertices[v]);
  }
  return interfaces.empty() ? Vec3(Vec3::Zero()) : box.center();
}

}  // namespace

FacetPlane plane_of(const std::array<Vec3, 3>& p) noexcept {
  FacetPlane plane;
  plane.normal = (p[1] - p[0]).cross(p[2] - p[0]).normalized();
  plane.offset = plane.normal.dot(p[0]);
  return plane;
}

IndexedSurfaces::IndexedSurfaces(std::span<const Vec3> from, std::span<const Interface> interfaces,
                                 std::span<const Group> groups)
    : centre(find_centre(from, interfaces)) {
  std::uint32_t end = 0;
  for (const Interface& interface : interfaces) {
    for (const std::uint32_t v : interface.vertices) end = std::max(end, v + 1);
  }
  const std::vector<std::uint32_t> number_of = place_vertices(from.first(end), groups);
  triangles.reserve(interfaces.size());
  facets.reserve(interfaces.size());
  std::vector<std::uint32_t> at_boundary;
  for (const Interface& interface : interfaces) {
    const auto& [a, b, c] = interface.vertices;
    const Corners& triangle =
        triangles.emplace_back(Corners{number_of[a], number_of[b], number_of[c]});
    const std::array<Vec3, 3> corners{vertices[triangle[0]], vertices[triangle[1]],
                                      vertices[triangle[2]]};
    facets.push_back({plane_of(corners), {interface.front, interface.back}});
    for (const Vec3& corner : corners) radius = std::max(radius, corner.norm());
    if (touches(facets.back().sides, kBeyond))
      at_boundary.push_back(static_cast<std::uint32_t>(triangles.size() - 1));
  }
  if (!groups.empty()) make_blocks();
  std::vector<std::uint32_t> each(interfaces.size());
  std::iota(each.begin(), each.end(), 0U);
  all = part_of(std::move(each));
  boundary = part_of(std::move(at_boundary));
}

/// Returns the number that each of `from` has.
std::vector<std::uint32_t> IndexedSurfaces::place_vertices(std::span<const Vec3> from,
                                                           std::span<const Group> groups) {
  constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> number_of(from.size(), kNone);
  vertices.reserve(from.size());
  const auto place = [&](std::uint32_t v) {
    number_of[v] = static_cast<std::uint32_t>(vertices.size());
    vertices.emplace_back(from[v] - centre);
  };
  for (const Group& group : groups) {
    begins.push_back(static_cast<std::uint32_t>(vertices.size()));
    for (const std::uint32_t v : group) {
      ARTUS_REQUIRE(v < from.size() && number_of[v] == kNone, "a vertex of one group");
      place(v);
    }
  }
  begins.push_back(static_cast<std::uint32_t>(vertices.size()));
  for (std::uint32_t v = 0; v < from.size(); ++v)
    if (number_of[v] == kNone) place(v);
  return number_of;
}

IndexedSurfaces::Part IndexedSurfaces::part_of(std::vector<std::uint32_t> interfaces) const {
  Part part;
  if (can_move()) {
    part.members.resize(n_blocks);
    for (const std::uint32_t i : interfaces) part.members[block_of[i]].push_back(i);
  } else {
    part.members.push_back(std::move(interfaces));
  }
  for (std::vector<std::uint32_t>& members : part.members) {
    members.shrink_to_fit();
    std::vector<Corners>& corners = part.corners.emplace_back();
    corners.reserve(members.size());
    for (const std::uint32_t i : members) corners.push_back(triangles[i]);
  }
  return part;
}

/// A block for the triangles of each group, and one for those between it and groups of larger
/// numbers, so that a group that moves alone leaves most of its neighbours' triangles alone.
void IndexedSurfaces::make_blocks() {
  const auto still = static_cast<std::uint32_t>(begins.size() - 1);
  std::vector<std::uint32_t> group(vertices.size(), still);
  for (std::uint32_t g = 0; g < still; ++g)
    std::fill(group.begin() + begins[g], group.begin() + begins[g + 1], g);
  std::map<std::array<std::uint32_t, 2>, std::uint32_t> known;  // by group, and whether between
  blocks_at.resize(still);
  block_of.reserve(triangles.size());
  for (const auto& [a, b, c] : triangles) {
    const auto [least, most] = std::minmax({group[a], group[b], group[c]});
    const std::array<std::uint32_t, 2> key{least, least == most ? 0U : 1U};
    const std::uint32_t block =
        known.try_emplace(key, static_cast<std::uint32_t>(known.size())).first->second;
    block_of.push_back(block);
    for (const std::uint32_t v : {a, b, c}) {
      if (group[v] < still) blocks_at[group[v]].push_back(block);
    }
  }
  for (std::vector<std::uint32_t>& blocks : blocks_at) {
    std::sort(blocks.begin(), blocks.end());
    blocks.erase(std::unique(blocks.begin(), blocks.end()), blocks.end());
    blocks.shrink_to_fit();
  }
  n_blocks = known.size();
  radii.assign(still + 1U, 0);
  for (const auto& corners : triangles) {
    for (const std::uint32_t v : corners)
      radii[group[v]] = std::max(radii[group[v]], vertices[v].norm());
  }
}

}  // namespace artus
