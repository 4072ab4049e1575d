// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/soft/injected_body.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <utility>

#include "artus/core/check.h"

namespace artus {
namespace {

constexpr double kVisible = 1e-9;        // m^3
constexpr double kLongestSplit = 15e-3;  // m, half of the length; 10 to 30 mm in all, assumed
constexpr int kSubdivisions = 3;         // of an icosahedron

struct Sphere {
  std::vector<Vec3> points;
  std::vector<std::array<std::uint32_t, 3>> triangles;  // normals outward
  double volume = 0;                                    // of the polyhedron
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
  for (const auto& [a, b, c] : s.triangles)
    s.volume += s.points[a].dot(s.points[b].cross(s.points[c])) / 6;
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

/// Cuts interfaces at the middles of the edges that are too long for the map beside the unit ball
/// of `in`, so that they follow it: a wall of few triangles would cut through the liquid. An edge
/// is judged by its ends alone, so neighbours agree.
void refine_beside(CompiledJoint& joint, const Eigen::Matrix3d& in, const Vec3& centre) {
  constexpr int kTimes = 6;
  constexpr double kFar = 3;      // radii beyond which the map hardly bends anything
  constexpr double kLong = 0.25;  // of an edge against its distance from the middle
  constexpr double kNear = 0.4;   // radii; closer to the middle edges need not be shorter for that
  std::vector<Vec3>& points = joint.mesh.vertices;
  for (int k = 0; k < kTimes; ++k) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto cut = [&](std::uint32_t one, std::uint32_t other) -> MidVertex {
      const std::pair<std::uint32_t, std::uint32_t> ends = std::minmax(one, other);
      const Vec3 from = in * (points[ends.first] - centre);
      const Vec3 along = in * (points[ends.second] - points[ends.first]);
      const double length = along.norm();
      if (!(length > 0)) return kWhole;
      const double t = std::clamp(-from.dot(along) / (length * length), 0.0, 1.0);
      const double nearest = (from + t * along).norm();
      if (nearest > kFar || length < kLong * std::max(nearest, kNear)) return kWhole;
      const auto [at, is_new] =
          middles.try_emplace(ends, static_cast<std::uint32_t>(points.size()));
      if (is_new) points.push_back((points[ends.first] + points[ends.second]) / 2);
      return at->second;
    };
    std::vector<Interface> finer;
    finer.reserve(joint.mesh.interfaces.size());
    for (const Interface& f : joint.mesh.interfaces) {
      const auto& [a, b, c] = f.vertices;
      add_pieces(f, {cut(a, b), cut(b, c), cut(c, a)}, finer);
    }
    if (middles.empty()) break;
    joint.mesh.interfaces = std::move(finer);
  }
}

Vec3 toward_skin(const CompiledJoint& joint, const Vec3& p) {
  double least = std::numeric_limits<double>::infinity();
  Vec3 way = Vec3::UnitZ();
  for (const Interface& f : joint.mesh.interfaces) {
    if (f.front != kOutside && f.back != kOutside) continue;
    const Vec3 to = joint.mesh.vertices[f.vertices[0]] - p;
    if (to.squaredNorm() < least && to.norm() > 0) {
      least = to.squaredNorm();
      way = to.normalized();
    }
  }
  return way;
}

/// The liquid as a tissue of the joint: what sound meets in it, with its grains. The tissue of that
/// name, or water-like where the joint has none.
TissueId liquid_tissue(CompiledJoint& joint, const Liquid& liquid) {
  const std::string name = "injected_" + liquid.name;
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

}  // namespace

Bolus make_bolus(const CompiledJoint& joint, RegionId region, const Vec3& tip, double volume) {
  Bolus bolus{region, tip, Eigen::Matrix3d::Identity(), Vec3::Ones(), volume};
  const TissueKind kind = joint.tissue_of(region).acoustic.kind;
  const Vec3 skin = toward_skin(joint, tip);
  Vec3 along = joint.regions[region].fibre_axis;
  // A region has one axis for all of its fibres; near the skin they run along it.
  along -= along.dot(skin) * skin;
  const bool fibrous = along.norm() > 0.1;
  along = fibrous ? along.normalized() : skin.unitOrthogonal();
  Vec3 up = skin - skin.dot(along) * along;
  up = up.norm() > 1e-3 ? up.normalized() : along.unitOrthogonal();
  bolus.axes.col(0) = along;
  bolus.axes.col(1) = up.cross(along);
  bolus.axes.col(2) = up;
  if (kind == TissueKind::muscle) {
    bolus.proportion = Vec3(3, 2, 0.6);
  } else if (fibrous || kind == TissueKind::nerve) {
    bolus.proportion = Vec3(8, 3, 0.5);
    // No longer than fibres part; what does not fit goes aside.
    const double ball = 4 * std::numbers::pi / 3;
    const double side = std::sqrt(volume / (ball * kLongestSplit * 3 * 0.5));
    if (8 * side > kLongestSplit) bolus.proportion.x() = kLongestSplit / side;
  } else {
    bolus.proportion = Vec3(4, 4, 1);
  }
  return bolus;
}

CompiledJoint with_bolus(const CompiledJoint& joint, const Bolus& bolus, const Liquid& liquid) {
  ARTUS_REQUIRE(bolus.volume > 0, "a volume above 0");
  const Sphere sphere = make_sphere();
  const double scale = std::cbrt(bolus.volume / (sphere.volume * bolus.proportion.prod()));
  const Eigen::Matrix3d out = bolus.axes * (scale * bolus.proportion).asDiagonal();
  const Eigen::Matrix3d in = out.inverse();
  CompiledJoint with = joint;
  refine_beside(with, in, bolus.centre);
  for (Vec3& p : with.mesh.vertices) {
    const Vec3 y = in * (p - bolus.centre);
    const double rho = y.norm();
    if (rho < 1e-9) {
      p = bolus.centre + out.col(0);
      continue;
    }
    p = bolus.centre + out * (std::cbrt(1 + 1 / (rho * rho * rho)) * y);
  }
  const auto number = static_cast<RegionId>(with.regions.size());
  with.regions.push_back({"injected", liquid_tissue(with, liquid), Vec3::Zero()});
  const auto first = static_cast<std::uint32_t>(with.mesh.vertices.size());
  for (const Vec3& p : sphere.points) with.mesh.vertices.push_back(bolus.centre + out * p);
  for (const auto& [a, b, c] : sphere.triangles) {
    Interface f;
    f.vertices = {first + a, first + b, first + c};
    f.front = bolus.region;
    f.back = number;
    with.mesh.interfaces.push_back(f);
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
                            const Liquid& liquid) {
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
               : with_bolus(with, make_bolus(with, region, place.tip, place.volume), liquid);
  }
  return with;
}

}  // namespace artus
