// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/soft/injected_body.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <span>
#include <utility>

#include "artus/core/check.h"
#include "artus/soft/cleft.h"
#include "artus/soft/inflated_space.h"

namespace artus {
namespace {

constexpr double kVisible = 1e-9;  // m^3
constexpr int kSubdivisions = 3;   // of an icosahedron

struct Sphere {
  std::vector<Vec3> points;
  std::vector<std::array<std::uint32_t, 3>> triangles;  // normals outward
};

Sphere make_icosahedron() {
  const double t = std::numbers::phi;
  Sphere s;
  for (const auto& [a, b, c] : std::initializer_list<std::array<double, 3>>{{-1, t, 0},
                                                                            {1, t, 0},
                                                                            {-1, -t, 0},
                                                                            {1, -t, 0},
                                                                            {0, -1, t},
                                                                            {0, 1, t},
                                                                            {0, -1, -t},
                                                                            {0, 1, -t},
                                                                            {t, 0, -1},
                                                                            {t, 0, 1},
                                                                            {-t, 0, -1},
                                                                            {-t, 0, 1}})
    s.points.push_back(Vec3(a, b, c).normalized());
  s.triangles = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                 {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                 {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                 {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
  return s;
}

Sphere make_sphere() {
  Sphere s = make_icosahedron();
  for (int k = 0; k < kSubdivisions; ++k) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
      const auto [at, is_new] =
          middles.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(s.points.size()));
      if (is_new) s.points.push_back((s.points[a] + s.points[b]).normalized());
      return at->second;
    };
    std::vector<std::array<std::uint32_t, 3>> finer;
    for (const auto& [a, b, c] : s.triangles) {
      const std::uint32_t ab = middle(a, b);
      const std::uint32_t bc = middle(b, c);
      const std::uint32_t ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
    }
    s.triangles = std::move(finer);
  }
  return s;
}

using MidVertex = std::uint32_t;  // vertex in the middle of an edge
constexpr MidVertex kWhole = std::numeric_limits<MidVertex>::max();

/// The triangle in pieces by which of its edges ab, bc, ca are cut.
void add_pieces(const Interface& f, std::array<MidVertex, 3> cuts, std::vector<Interface>& out) {
  const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    out.push_back(f);
    out.back().vertices = {a, b, c};
  };
  const auto is_cut = [&](std::size_t k) {
    return cuts[k] != kWhole;
  };
  auto v = f.vertices;
  // Turned until the first edge is cut and, of two, the second as well.
  for (int turn = 0; turn < 2 && !(is_cut(0) && (is_cut(1) || !is_cut(2))); ++turn) {
    std::rotate(cuts.begin(), cuts.begin() + 1, cuts.end());
    std::rotate(v.begin(), v.begin() + 1, v.end());
  }
  const auto [a, b, c] = v;
  if (!is_cut(0)) {
    add(a, b, c);
  } else if (!is_cut(1)) {
    add(a, cuts[0], c);
    add(cuts[0], b, c);
  } else {
    add(cuts[0], b, cuts[1]);
    if (is_cut(2)) {
      add(a, cuts[0], cuts[2]);
      add(cuts[2], cuts[1], c);
      add(cuts[0], cuts[1], cuts[2]);
    } else {
      add(a, cuts[0], cuts[1]);
      add(a, cuts[1], c);
    }
  }
}

/// Cuts interfaces at the middles of the edges that are too long for the map beside a cleft, so
/// that they follow it: a wall of few triangles would cut through the liquid. An edge is judged by
/// its ends alone, so neighbours agree.
void refine_beside(CompiledJoint& joint, const Cleft& cleft) {
  constexpr int kTimes = 6;
  constexpr double kFar = 3;      // radii beyond which the map hardly bends anything
  constexpr double kLong = 0.17;  // of an edge against its distance from the middle
  constexpr double kNear = 0.4;   // radii; closer to the middle edges need not be shorter for that
  std::vector<Vec3>& points = joint.mesh.vertices;
  std::vector<Vec3> places;
  places.reserve(points.size());
  for (const Vec3& p : points) places.push_back(cleft.local(p));
  const auto is_long = [&](std::uint32_t one, std::uint32_t other) {
    const std::pair<std::uint32_t, std::uint32_t> ends = std::minmax(one, other);
    const Vec3& from = places[ends.first];
    const Vec3 along = places[ends.second] - from;
    const double length = along.norm();
    if (!(length > 0)) return false;
    const double t = std::clamp(-from.dot(along) / (length * length), 0.0, 1.0);
    const double nearest = (from + t * along).norm();
    return nearest <= kFar && length >= kLong * std::max(nearest, kNear);
  };
  const auto is_whole = [&](const Interface& f) {
    const auto& [a, b, c] = f.vertices;
    return !is_long(a, b) && !is_long(b, c) && !is_long(c, a);
  };
  std::vector<Interface>& faces = joint.mesh.interfaces;
  std::size_t whole = 0;  // faces that need no cut come first
  for (int k = 0; k < kTimes; ++k) {
    const auto begin = faces.begin() + static_cast<std::ptrdiff_t>(whole);
    const auto cut_from = std::stable_partition(begin, faces.end(), is_whole);
    whole = static_cast<std::size_t>(cut_from - faces.begin());
    if (cut_from == faces.end()) break;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto cut = [&](std::uint32_t one, std::uint32_t other) -> MidVertex {
      if (!is_long(one, other)) return kWhole;
      const std::pair<std::uint32_t, std::uint32_t> ends = std::minmax(one, other);
      const auto [at, is_new] =
          middles.try_emplace(ends, static_cast<std::uint32_t>(points.size()));
      if (is_new) {
        points.push_back((points[ends.first] + points[ends.second]) / 2);
        places.push_back(cleft.local(points.back()));
      }
      return at->second;
    };
    std::vector<Interface> finer;
    for (auto f = cut_from; f != faces.end(); ++f) {
      const auto& [a, b, c] = f->vertices;
      add_pieces(*f, {cut(a, b), cut(b, c), cut(c, a)}, finer);
    }
    faces.resize(whole);
    faces.insert(faces.end(), finer.begin(), finer.end());
  }
}

/// The liquid as a tissue of the joint: what sound meets in it, with its grains. The tissue of that
/// name, or water-like where the joint has none.
TissueId liquid_tissue(CompiledJoint& joint, const Liquid& liquid) {
  const std::string name = injected_tissue_name(liquid);
  const auto find = [&](const std::string& wanted) {
    return std::find_if(joint.tissues.begin(), joint.tissues.end(),
                        [&](const Tissue& t) { return t.name == wanted; });
  };
  if (const auto at = find(name); at != joint.tissues.end())
    return static_cast<TissueId>(at - joint.tissues.begin());
  Tissue tissue;
  if (const auto at = find(liquid.tissue); at != joint.tissues.end()) tissue = *at;
  tissue.name = name;
  tissue.acoustic.backscatter = std::max(tissue.acoustic.backscatter, liquid.backscatter);
  tissue.acoustic.kind = TissueKind::fluid;
  joint.tissues.push_back(std::move(tissue));
  return static_cast<TissueId>(joint.tissues.size() - 1);
}

/// m^3 inside the unit sphere's triangles over these corners.
double enclosed_by(const Sphere& unit, const std::vector<Vec3>& corners) {
  double six = 0;
  for (const auto& [a, b, c] : unit.triangles)
    six += (corners[a] - corners[0]).dot((corners[b] - corners[0]).cross(corners[c] - corners[0]));
  return six / 6;
}

/// The corners of the liquid, and the cleft scaled so that it holds its volume.
std::vector<Vec3> open_wall(const Sphere& unit, double volume, Cleft& cleft) {
  constexpr double kLeast = 0.05;  // of the volume that bone leaves it
  std::vector<Vec3> corners;
  const auto place = [&] {
    corners.clear();
    for (const Vec3& p : unit.points) corners.push_back(cleft.wall(p));
    return enclosed_by(unit, corners);
  };
  const double once = place();  // what it holds grows evenly with how far it opens
  cleft.scale(2);
  const double each = place() - once;
  if (!(each > kLeast * volume)) return {};
  cleft.scale((1 + (volume - once) / each) / 2);
  static_cast<void>(place());
  return corners;
}

/// Opens one as region `number`.
void open_bolus(CompiledJoint& with, const Bolus& bolus, RegionId number,
                std::span<const Vec3> bone) {
  const Sphere unit = make_sphere();
  Cleft cleft(bolus, bone);
  std::vector<Vec3> corners = open_wall(unit, bolus.volume, cleft);
  if (corners.empty()) {  // between bones: what is there is squeezed
    cleft = Cleft(bolus, {});
    corners = open_wall(unit, bolus.volume, cleft);
  }
  refine_beside(with, cleft);
  std::vector<bool> hard(with.mesh.vertices.size(), false);
  for (const Interface& f : with.mesh.interfaces)
    if (with.tissue_of(f.front).haptic.hard || with.tissue_of(f.back).haptic.hard)
      for (const std::uint32_t v : f.vertices) hard[v] = true;
  for (std::size_t v = 0; v < hard.size(); ++v)
    if (!hard[v]) with.mesh.vertices[v] = cleft.moved(with.mesh.vertices[v]);
  const auto first = static_cast<std::uint32_t>(with.mesh.vertices.size());
  with.mesh.vertices.insert(with.mesh.vertices.end(), corners.begin(), corners.end());
  for (const auto& [a, b, c] : unit.triangles) {
    Interface f;
    f.vertices = {first + a, first + b, first + c};
    f.front = bolus.region;
    f.back = number;
    with.mesh.interfaces.push_back(f);
  }
}

}  // namespace

CompiledJoint with_boluses(const CompiledJoint& joint, const std::vector<Bolus>& boluses,
                           const Liquid& liquid) {
  CompiledJoint with = joint;
  const auto number = static_cast<RegionId>(with.regions.size());
  with.regions.push_back({"injected", liquid_tissue(with, liquid), Vec3::Zero()});
  if (boluses.empty()) return with;
  const std::vector<Vec3> bone = find_bone_points(joint, boluses.back().centre);
  for (const Bolus& bolus : boluses) {
    ARTUS_REQUIRE(bolus.volume > 0, "a volume above 0");
    open_bolus(with, bolus, number, bone);
  }
  return with;
}

CompiledJoint with_filled_space(const CompiledJoint& joint, RegionId region, const Vec3& tip,
                                double volume, const Liquid& liquid) {
  CompiledJoint with = joint;
  with.mesh.vertices = InflatedSpace(joint, region, tip).vertices(volume);
  with.regions[region].tissue = liquid_tissue(with, liquid);
  return with;
}

CompiledJoint with_injected(const CompiledJoint& joint, const std::vector<Injected>& places,
                            const Liquid& liquid, const FibreField& fibres) {
  // Tissue first: where it is parted is told of the body at rest, and is lifted with what opens.
  std::vector<Injected> ordered = places;
  std::stable_partition(ordered.begin(), ordered.end(),
                        [](const Injected& place) { return !place.cavity; });
  CompiledJoint with = joint;
  for (const Injected& place : ordered) {
    const auto at = std::find_if(joint.regions.begin(), joint.regions.end(),
                                 [&](const Region& r) { return r.name == place.region; });
    if (at == joint.regions.end() || !(place.volume >= kVisible)) continue;
    const auto region = static_cast<RegionId>(at - joint.regions.begin());
    if (region < kFirstRegion) continue;
    with = place.cavity
               ? with_filled_space(with, region, place.tip, place.volume, liquid)
               : with_boluses(with, make_boluses(with, region, place.tip, place.volume, fibres),
                              liquid);
  }
  return with;
}

}  // namespace artus
