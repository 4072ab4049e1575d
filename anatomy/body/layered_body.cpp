// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/body/layered_body.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "artus/detail/core/check.h"

namespace artus {
namespace {

TissueId tissue_named(const std::vector<Tissue>& tissues, std::string_view name) {
  const auto found = std::find_if(tissues.begin(), tissues.end(),
                                  [&](const Tissue& tissue) { return tissue.name == name; });
  ARTUS_REQUIRE(found != tissues.end(), "no such tissue: " + std::string(name));
  return static_cast<TissueId>(found - tissues.begin());
}

CompiledJoint make_empty_joint(const std::string& name, const std::vector<Tissue>& tissues) {
  CompiledJoint joint;
  joint.name = name;
  joint.side = "none";
  joint.axes = "LPS";
  joint.tissues = tissues;
  const TissueId gel = tissue_named(tissues, "gel");
  joint.regions = {{"outside", gel, Vec3::Zero()}, {"beyond", gel, Vec3::Zero()}};
  joint.source_digest = "0";
  return joint;
}

RegionId add_region(CompiledJoint& joint, const std::string& name, const std::string& tissue) {
  const auto taken = [&](const std::string& candidate) {
    return std::any_of(joint.regions.begin(), joint.regions.end(),
                       [&](const Region& region) { return region.name == candidate; });
  };
  std::string unique = name;
  for (int i = 2; taken(unique); ++i) unique = name + "_" + std::to_string(i);
  joint.regions.push_back({unique, tissue_named(joint.tissues, tissue), Vec3::Zero()});
  return static_cast<RegionId>(joint.regions.size() - 1);
}

std::uint32_t add_vertex(CompiledJoint& joint, const Vec3& p) {
  joint.mesh.vertices.push_back(p);
  return static_cast<std::uint32_t>(joint.mesh.vertices.size() - 1);
}

using Quad = std::array<std::uint32_t, 4>;

/// Two triangles, counter-clockwise seen from `front`.
void add_quad(CompiledJoint& joint, const Quad& q, RegionId front, RegionId back) {
  joint.mesh.interfaces.push_back({{q[0], q[1], q[2]}, front, back});
  joint.mesh.interfaces.push_back({{q[0], q[2], q[3]}, front, back});
}

struct Surface {
  std::vector<Vec3> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

Surface make_icosahedron() {
  const double g = (1 + std::sqrt(5.0)) / 2;
  Surface s;
  s.vertices = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  s.triangles = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                 {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                 {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                 {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
  for (Vec3& v : s.vertices) v.normalize();
  return s;
}

Surface split(const Surface& in) {
  Surface out;
  out.vertices = in.vertices;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
  const auto middle = [&](std::uint32_t a, std::uint32_t b) {
    const auto [place, fresh] = middles.try_emplace(
        {std::min(a, b), std::max(a, b)}, static_cast<std::uint32_t>(out.vertices.size()));
    if (fresh) out.vertices.push_back((in.vertices[a] + in.vertices[b]).normalized());
    return place->second;
  };
  for (const auto& [a, b, c] : in.triangles) {
    const std::uint32_t ab = middle(a, b);
    const std::uint32_t bc = middle(b, c);
    const std::uint32_t ca = middle(c, a);
    out.triangles.insert(out.triangles.end(),
                         {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
  }
  return out;
}

struct Sides {
  RegionId front = kOutside;
  RegionId back = kOutside;
};

void add_sphere(CompiledJoint& joint, const Vec3& centre, double radius, int subdivisions,
                const Sides& sides) {
  Surface surface = make_icosahedron();
  for (int i = 0; i < subdivisions; ++i) surface = split(surface);
  const auto base = static_cast<std::uint32_t>(joint.mesh.vertices.size());
  for (const Vec3& v : surface.vertices) joint.mesh.vertices.emplace_back(centre + radius * v);
  for (const auto& t : surface.triangles) {
    joint.mesh.interfaces.push_back(
        {{base + t[0], base + t[1], base + t[2]}, sides.front, sides.back});
  }
}

void set_default_poses(CompiledJoint& joint, const Vec3& top, double depth) {
  joint.X_JP_default = make_pose(top, Vec3::UnitZ(), Vec3::UnitX());
  joint.X_JN_default = make_pose(top + 0.5 * depth * Vec3::UnitZ(), Vec3::UnitZ(), Vec3::UnitX());
  joint.injections = {{"first", top, top + 0.5 * depth * Vec3::UnitZ()}};
}

}  // namespace

RegionId region_named(const CompiledJoint& joint, std::string_view name) {
  const auto found = std::find_if(joint.regions.begin(), joint.regions.end(),
                                  [&](const Region& region) { return region.name == name; });
  ARTUS_REQUIRE(found != joint.regions.end(), "no such region: " + std::string(name));
  return static_cast<RegionId>(found - joint.regions.begin());
}

CompiledJoint make_layered_block(const std::vector<Tissue>& tissues,
                                 std::span<const FlatLayer> layers, double width_x, double depth_y,
                                 const Vec3& top_centre) {
  CompiledJoint joint = make_empty_joint("layered-block", tissues);
  std::vector<Quad> levels;
  const auto add_level = [&](double z) {
    const double x = width_x / 2;
    const double y = depth_y / 2;
    levels.push_back({add_vertex(joint, top_centre + Vec3(-x, -y, z)),
                      add_vertex(joint, top_centre + Vec3(x, -y, z)),
                      add_vertex(joint, top_centre + Vec3(x, y, z)),
                      add_vertex(joint, top_centre + Vec3(-x, y, z))});
  };
  double z = 0;
  RegionId above = kOutside;
  add_level(z);
  for (const FlatLayer& layer : layers) {
    const RegionId region = add_region(joint, layer.tissue, layer.tissue);
    const Quad top = levels.back();
    add_quad(joint, {top[0], top[3], top[2], top[1]}, above, region);
    z += layer.thickness;
    add_level(z);
    const Quad& bottom = levels.back();
    for (std::size_t i = 0; i < 4; ++i) {
      const std::size_t j = (i + 1) % 4;
      add_quad(joint, {top[i], top[j], bottom[j], bottom[i]}, kOutside, region);
    }
    above = region;
  }
  add_quad(joint, levels.back(), kOutside, above);
  set_default_poses(joint, top_centre, z);
  return joint;
}

void add_ball(CompiledJoint& joint, const Ball& ball, RegionId within, int subdivisions) {
  const RegionId inside = add_region(joint, ball.tissue, ball.tissue);
  add_sphere(joint, ball.centre, ball.radius, subdivisions, {within, inside});
}

CompiledJoint make_nested_spheres(const std::vector<Tissue>& tissues,
                                  std::span<const SphereLayer> layers, const Vec3& centre,
                                  int subdivisions) {
  CompiledJoint joint = make_empty_joint("nested-spheres", tissues);
  RegionId outer = kOutside;
  for (const SphereLayer& layer : layers) {
    const RegionId region = add_region(joint, layer.tissue, layer.tissue);
    add_sphere(joint, centre, layer.radius, subdivisions, {outer, region});
    outer = region;
  }
  if (!layers.empty()) {
    const double radius = layers.front().radius;
    set_default_poses(joint, centre - radius * Vec3::UnitZ(), 2 * radius);
  }
  return joint;
}

CompiledJoint make_block_with_sphere(const std::vector<Tissue>& tissues,
                                     const BlockWithSphere& block) {
  const std::array<FlatLayer, 1> layer{{{block.tissue, block.size.z()}}};
  CompiledJoint joint =
      make_layered_block(tissues, layer, block.size.x(), block.size.y(), block.top_centre);
  joint.regions.back().name = "block";
  const RegionId inside = add_region(joint, "inclusion", block.inclusion);
  add_sphere(joint, block.centre, block.radius, block.subdivisions, {kFirstRegion, inside});
  return joint;
}

CompiledJoint subdivided(const CompiledJoint& joint, int times) {
  ARTUS_REQUIRE(joint.mesh.tetrahedra.empty(), "surfaces alone can be cut");
  CompiledJoint fine = joint;
  for (int k = 0; k < times; ++k) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
      const auto [place, is_new] = middles.try_emplace(std::minmax(a, b), 0U);
      if (is_new)
        place->second = add_vertex(fine, 0.5 * (fine.mesh.vertices[a] + fine.mesh.vertices[b]));
      return place->second;
    };
    std::vector<Interface> cut;
    cut.reserve(4 * fine.mesh.interfaces.size());
    for (const Interface& i : fine.mesh.interfaces) {
      const auto [a, b, c] = i.vertices;
      const std::uint32_t ab = middle(a, b);
      const std::uint32_t bc = middle(b, c);
      const std::uint32_t ca = middle(c, a);
      for (const auto& corners : {std::array{a, ab, ca}, std::array{ab, b, bc},
                                  std::array{ca, bc, c}, std::array{ab, bc, ca}})
        cut.push_back({corners, i.front, i.back});
    }
    fine.mesh.interfaces = std::move(cut);
  }
  return fine;
}

CompiledJoint transformed(const CompiledJoint& joint, const Pose& X_new_old) {
  CompiledJoint moved = joint;
  for (Vec3& v : moved.mesh.vertices) v = X_new_old * v;
  for (Landmark& landmark : moved.landmarks) landmark.position = X_new_old * landmark.position;
  for (Region& region : moved.regions) region.fibre_axis = X_new_old.linear() * region.fibre_axis;
  for (PlannedInjection& injection : moved.injections) {
    injection.entry = X_new_old * injection.entry;
    injection.target = X_new_old * injection.target;
  }
  moved.X_JP_default = X_new_old * joint.X_JP_default;
  moved.X_JN_default = X_new_old * joint.X_JN_default;
  return moved;
}

}  // namespace artus
