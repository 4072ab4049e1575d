// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/soft/liquid/overflow.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <span>

#include <Eigen/Dense>

#include "artus/detail/anatomy/body/find_region.h"
#include "artus/detail/anatomy/body/space.h"
#include "artus/detail/anatomy/body/tissue.h"
#include "artus/detail/core/closest_point.h"

namespace artus {
namespace {

constexpr int kRounds = 4;        // a full space spills into what may tear the next
constexpr double kDrawn = 1e-9;   // m^3
constexpr double kTorn = 1e-6;    // m^3 that are drawn of what tears out; the rest spreads; assumed
constexpr double kPocket = 1e-3;  // m that tips of one pocket may lie apart; assumed
constexpr double kInto = 0.5e-3;  // m behind the wall, where it begins to part tissue

/// What parts, next to a space.
struct Beyond {
  RegionId region = kOutside;
  Vec3 p = Vec3::Zero();
};

/// Liquid that parts tissue at the tip, as thick as it is there.
struct Parting {
  Vec3 middle = Vec3::Zero();  // m, across the layers from the tip
  double half = 0;             // m to either side of it
};

Parting parting_of(const CompiledJoint& joint, RegionId region, const Injected& place) {
  const Bolus bolus = make_boluses(joint, region, place.tip, place.volume).back();
  const Vec3 across = bolus.axes.col(2);
  return {place.tip + across.dot(bolus.centre - place.tip) * across, bolus.semi_axes().z()};
}

/// Of the tetrahedron that holds a point; outside where none does.
RegionId region_at(const TetMesh& mesh, const Vec3& p) {
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    const auto& v = mesh.tetrahedra[t];
    const Vec3& a = mesh.vertices[v[0]];
    Eigen::Matrix3d edges;
    for (int k = 0; k < 3; ++k)
      edges.col(k) = mesh.vertices[v[static_cast<std::size_t>(k + 1)]] - a;
    if ((p - a).cwiseAbs().maxCoeff() > edges.cwiseAbs().maxCoeff()) continue;
    const Vec3 share = edges.inverse() * (p - a);
    if (share.minCoeff() >= 0 && share.sum() <= 1) return mesh.regions[t];
  }
  return kOutside;
}

/// Of a region's tetrahedra the nearest one's middle.
std::optional<Vec3> nearest_middle(const TetMesh& mesh, RegionId region, const Vec3& p) {
  std::optional<Vec3> nearest;
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    if (mesh.regions[t] != region) continue;
    Vec3 middle = Vec3::Zero();
    for (const std::uint32_t v : mesh.tetrahedra[t]) middle += mesh.vertices[v] / 4;
    if (!nearest || (middle - p).squaredNorm() < (*nearest - p).squaredNorm()) nearest = middle;
  }
  return nearest;
}

/// The nearest point of a region to one beside it, as far inside as it has room.
std::optional<Vec3> nearest_inside(const CompiledJoint& joint, RegionId region, const Vec3& tip) {
  const auto& p = joint.mesh.vertices;
  double nearest = std::numeric_limits<double>::infinity();
  Vec3 on = tip;
  Vec3 inward = Vec3::Zero();
  for (const Interface& f : joint.mesh.interfaces) {
    if ((f.front == region) == (f.back == region)) continue;
    const std::array<Vec3, 3> t{p[f.vertices[0]], p[f.vertices[1]], p[f.vertices[2]]};
    const Vec3 q = closest_point_on_triangle(tip, t);
    const double away = (q - tip).norm();
    const Vec3 normal = (t[1] - t[0]).cross(t[2] - t[0]);
    if (away >= nearest || !(normal.norm() > 0)) continue;
    nearest = away;
    on = q;
    inward = (f.front == region ? 1 : -1) * normal.normalized();
  }
  for (const double depth : {kInto, kInto / 2, kInto / 5, kInto / 20})
    if (region_at(joint.mesh, on + depth * inward) == region) return on + depth * inward;
  return nearest_middle(joint.mesh, region, tip);  // of a rim that is thinner still
}

/// What parts two tissues at one place is one pocket, in the one that got more.
void join_pockets(const CompiledJoint& joint, std::vector<Injected>& places) {
  const auto parts = [&joint](const Injected& place) {
    return !place.cavity && find_region(joint, place.region).value_or(kOutside) >= kFirstRegion;
  };
  for (Injected& place : places)
    for (Injected& other : places) {
      const bool apart = &place == &other || !parts(place) || !parts(other) ||
                         (place.tip - other.tip).norm() > kPocket;
      if (apart || place.volume < other.volume) continue;
      place.volume += other.volume;
      other.volume = 0;
    }
}

/// What parts tissue does so in its own region. A wall that the needle tents lies ahead of its tip;
/// in the body at rest it may be behind it.
void bring_inside(const CompiledJoint& joint, std::vector<Injected>& places) {
  for (Injected& place : places) {
    const auto region = find_region(joint, place.region);
    if (place.cavity || !region || *region < kFirstRegion || !(place.volume > kDrawn)) continue;
    if (region_at(joint.mesh, place.tip) == *region) continue;
    place.tip = nearest_inside(joint, *region, place.tip).value_or(place.tip);
  }
}

/// Fat or muscle, which gives way: where it begins nearest to the tip, as far as that is away, and
/// twice as far where it is not above. In it far enough that liquid of `volume` does not come back.
std::optional<Beyond> tissue_beyond(const CompiledJoint& joint, const Vec3& tip, double volume) {
  const auto gives_way = [&](RegionId r) {
    if (r < kFirstRegion) return false;
    const TissueKind kind = joint.tissue_of(r).acoustic.kind;
    return kind == TissueKind::fat || kind == TissueKind::muscle;
  };
  const Vec3 up = -joint.X_JP_default.linear().col(2);
  double nearest = std::numeric_limits<double>::infinity();
  Beyond found;
  Vec3 into = up;
  for (const Interface& f : joint.mesh.interfaces) {
    if (gives_way(f.front) == gives_way(f.back)) continue;
    const auto& p = joint.mesh.vertices;
    const Vec3& a = p[f.vertices[0]];
    const Vec3 middle = (a + p[f.vertices[1]] + p[f.vertices[2]]) / 3;
    const Vec3 normal = (p[f.vertices[1]] - a).cross(p[f.vertices[2]] - a);
    if (!(normal.norm() > 0)) continue;
    const bool front = gives_way(f.front);
    const Vec3 inward = (front ? 1 : -1) * normal.normalized();
    const double away = (middle - tip).norm() * (1.5 - 0.5 * inward.dot(up));
    if (away >= nearest) continue;
    nearest = away;
    into = inward;
    found = {front ? f.front : f.back, middle + kInto * inward};
  }
  if (found.region < kFirstRegion) return std::nullopt;
  const Injected there{joint.regions[found.region].name, volume, false, found.p, 0};
  const Vec3 deep = found.p + (parting_of(joint, found.region, there).half + kHoldingFilm) * into;
  if (const RegionId region = region_at(joint.mesh, deep); gives_way(region))
    found = {region, deep};
  return found;
}

/// The cavity that it tears, and where its walls are nearest.
std::optional<Beyond> cavity_beside(const CompiledJoint& joint, const JointSpaces& spaces,
                                    const Vec3& middle, double reach) {
  const auto is_cavity = [&](RegionId r) {
    return r >= kFirstRegion && spaces.spaces[spaces.of_region[r]].law.kind == SpaceKind::cavity;
  };
  std::optional<Beyond> found;
  for (const Interface& f : joint.mesh.interfaces) {
    if (is_cavity(f.front) == is_cavity(f.back)) continue;
    const auto& p = joint.mesh.vertices;
    const std::array<Vec3, 3> t{p[f.vertices[0]], p[f.vertices[1]], p[f.vertices[2]]};
    const double away = (closest_point_on_triangle(middle, t) - middle).norm();
    if (away >= reach) continue;
    reach = away;
    found = Beyond{is_cavity(f.front) ? f.front : f.back, (t[0] + t[1] + t[2]) / 3};
  }
  return found;
}

/// m^3 that are put into a space, in whichever of its regions.
double given_to(const OpenedSpace& space, const CompiledJoint& joint,
                std::span<const Injected> places) {
  double given = 0;
  const auto in = space.regions();
  for (const Injected& place : places) {
    const auto region = find_region(joint, place.region);
    if (place.cavity && region && std::find(in.begin(), in.end(), *region) != in.end())
      given += place.volume;
  }
  return given;
}

/// Whether one did.
bool tear_films(const OpenedSpaces& spaces, const JointSpaces& laws,
                std::vector<Injected>& places) {
  const CompiledJoint& joint = spaces.joint();
  bool torn = false;
  for (Injected& place : places) {
    const auto region = find_region(joint, place.region);
    if (place.cavity || !region || !(place.volume > kDrawn)) continue;
    const Parting parting = parting_of(joint, *region, place);
    const auto beside = cavity_beside(joint, laws, parting.middle, parting.half + kHoldingFilm);
    if (!beside) continue;
    const OpenedSpace& space = spaces.of(beside->region);
    if (given_to(space, joint, places) + place.volume > space.max_volume()) continue;
    place.region = joint.regions[beside->region].name;
    place.cavity = true;
    place.tip = beside->p;
    torn = true;
  }
  return torn;
}

/// Beyond what a space holds before it tears. Whether one did.
bool spill(const OpenedSpaces& spaces, const JointSpaces& laws, std::vector<Injected>& places) {
  const CompiledJoint& joint = spaces.joint();
  bool spilt = false;
  for (std::size_t k = places.size(); k-- > 0;) {
    const auto region = find_region(joint, places[k].region);
    if (!places[k].cavity || !region) continue;
    const double most = laws.spaces[laws.of_region[*region]].law.rupture;
    const double given = given_to(spaces.of(*region), joint, places);
    const double more = std::min(given - most, places[k].volume);
    if (!(more > kDrawn)) continue;
    const auto beyond = tissue_beyond(joint, places[k].tip, std::min(more, kTorn));
    if (!beyond) continue;
    places[k].volume -= more;
    places.push_back(
        {joint.regions[beyond->region].name, std::min(more, kTorn), false, beyond->p, 0});
    spilt = true;
  }
  return spilt;
}

/// What is in parts of a space that the body does not have, or spreads in a thin layer of tissue.
void leave_out(const OpenedSpaces& spaces, std::vector<Injected>& places) {
  const CompiledJoint& joint = spaces.joint();
  for (std::size_t k = places.size(); k-- > 0;) {
    const auto region = find_region(joint, places[k].region);
    if (!region || *region < kFirstRegion || !(places[k].volume > kDrawn)) continue;
    if (!places[k].cavity) {
      places[k].volume = std::min(places[k].volume, room_at(joint, *region, places[k].tip));
      continue;
    }
    const OpenedSpace& space = spaces.of(*region);
    const double more = given_to(space, joint, places) - space.max_volume();
    places[k].volume -= std::clamp(more, 0.0, places[k].volume);
  }
}

}  // namespace

std::vector<Injected> with_overflow(const OpenedSpaces& spaces, std::vector<Injected> places) {
  const auto laws = make_joint_spaces(spaces.joint());
  if (!laws) return places;
  join_pockets(spaces.joint(), places);
  bring_inside(spaces.joint(), places);
  for (int round = 0; round < kRounds; ++round) {
    const bool torn = tear_films(spaces, *laws, places);
    const bool spilt = spill(spaces, *laws, places);
    if (!torn && !spilt) break;
  }
  leave_out(spaces, places);
  return places;
}

}  // namespace artus
