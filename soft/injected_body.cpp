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

namespace artus {
namespace {

constexpr double kVisible = 1e-9;        // m^3
constexpr double kLongestSplit = 15e-3;  // m, half of the length; 10 to 30 mm in all, assumed
constexpr double kBall = 4 * std::numbers::pi / 3;
constexpr int kSubdivisions = 3;  // of an icosahedron

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
  constexpr double kLong = 0.17;  // of an edge against its distance from the middle
  constexpr double kNear = 0.4;   // radii; closer to the middle edges need not be shorter for that
  std::vector<Vec3>& points = joint.mesh.vertices;
  const auto is_long = [&](std::uint32_t one, std::uint32_t other) {
    const std::pair<std::uint32_t, std::uint32_t> ends = std::minmax(one, other);
    const Vec3 from = in * (points[ends.first] - centre);
    const Vec3 along = in * (points[ends.second] - points[ends.first]);
    const double length = along.norm();
    if (!(length > 0)) return false;
    const double t = std::clamp(-from.dot(along) / (length * length), 0.0, 1.0);
    const double nearest = (from + t * along).norm();
    return nearest <= kFar && length >= kLong * std::max(nearest, kNear);
  };
  const double stretch = in.norm();  // at least what a length becomes
  const auto is_whole = [&](const Interface& f) {
    const auto& [a, b, c] = f.vertices;
    const double reach =
        std::max((points[b] - points[a]).norm(), (points[c] - points[a]).norm()) * stretch;
    if ((in * (points[a] - centre)).norm() - reach > kFar) return true;
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
      if (is_new) points.push_back((points[ends.first] + points[ends.second]) / 2);
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

/// How a tissue is parted.
struct Parting {
  Vec3 full = Vec3::Ones();  // m, semi-axes of one that is full: along fibres, beside, toward skin
  double longest = 1;        // m, half of a length
  double apart = 0;          // m between the planes of two; 0: one opens alone
  int rows = 0;              // of them behind each other along the fibres, to either side
};

Parting parting_of(const CompiledJoint& joint, RegionId region, bool fibrous) {
  const TissueKind kind = joint.tissue_of(region).acoustic.kind;
  if (kind == TissueKind::muscle) return {Vec3(10e-3, 5e-3, 0.7e-3), 1, 2e-3, 1};
  if (kind == TissueKind::nerve) return {Vec3(8e-3, 3e-3, 0.5e-3), kLongestSplit, 0, 0};
  if (fibrous) return {Vec3(12e-3, 8e-3, 0.6e-3), kLongestSplit, 1.5e-3, 0};
  return {Vec3(4e-3, 4e-3, 1e-3)};
}

/// Unit, in columns: along the fibres, beside them, toward the skin. A region has one axis for all
/// of its fibres; near the skin they run along it.
Eigen::Matrix3d axes_at(const CompiledJoint& joint, RegionId region, const Vec3& p, bool& fibrous) {
  const Vec3 skin = toward_skin(joint, p);
  Vec3 along = joint.regions[region].fibre_axis;
  along -= along.dot(skin) * skin;
  fibrous = along.norm() > 0.1;
  along = fibrous ? along.normalized() : skin.unitOrthogonal();
  Vec3 up = skin - skin.dot(along) * along;
  up = up.norm() > 1e-3 ? up.normalized() : along.unitOrthogonal();
  Eigen::Matrix3d axes;
  axes << along, up.cross(along), up;
  return axes;
}

/// The surface of one region.
class Walls {
 public:
  static constexpr double kFarAway = 1;  // m, where there is none

  Walls(const CompiledJoint& joint, RegionId region) {
    for (const Interface& f : joint.mesh.interfaces) {
      if ((f.front == region) == (f.back == region)) continue;
      const Vec3& a = joint.mesh.vertices[f.vertices[0]];
      const Vec3 ab = joint.mesh.vertices[f.vertices[1]] - a;
      const Vec3 ac = joint.mesh.vertices[f.vertices[2]] - a;
      walls_.push_back({a, ab, ac, f.back == region ? 1.0 : -1.0});
    }
  }
  /// m from p along d (unit) to the first wall; 0 where that leads into the region.
  [[nodiscard]] double reach(const Vec3& p, const Vec3& d) const {
    double nearest = kFarAway;
    bool out = true;
    for (const Wall& wall : walls_) {
      const Vec3 normal = wall.ab.cross(wall.ac);
      const double facing = d.dot(normal);
      const double t = (wall.a - p).dot(normal) / facing;
      if (!(t > 0 && t < nearest)) continue;
      const Vec3 q = p + t * d - wall.a;
      const double whole = normal.squaredNorm();
      const double u = q.cross(wall.ac).dot(normal) / whole;
      const double v = wall.ab.cross(q).dot(normal) / whole;
      if (u < 0 || v < 0 || u + v > 1) continue;
      nearest = t;
      out = facing * wall.outward > 0;
    }
    return out ? nearest : 0;
  }
  /// The shorter of the two ways.
  [[nodiscard]] double reach_both(const Vec3& p, const Vec3& d) const {
    return std::min(reach(p, d), reach(p, -d));
  }

 private:
  struct Wall {
    Vec3 a;
    Vec3 ab;
    Vec3 ac;
    double outward;  // 1: its normal leads out of the region
  };
  std::vector<Wall> walls_;
};

/// Where liquid opens a tissue beside the tip, in the order of how far away, m along the tip's own
/// axes.
std::vector<Vec3> places_of(const Parting& parting) {
  constexpr int kPlanes = 3;        // to either side of the tip's
  constexpr double kRow = 1.7;      // half lengths from one to the next along the fibres
  constexpr double kSide = 1.4;     // half widths beside them
  constexpr double kStagger = 0.4;  // half lengths by which planes are shifted, there and back
  std::vector<Vec3> places;
  if (!(parting.apart > 0)) return places;
  for (int m = -kPlanes; m <= kPlanes; ++m)
    for (int j = -1; j <= 1; ++j)
      for (int i = -parting.rows; i <= parting.rows; ++i) {
        if (m == 0 && j == 0 && i == 0) continue;
        const double shift = m % 2 == 0 ? 0 : (m > 0 ? kStagger : -kStagger);
        places.emplace_back((kRow * i + shift) * parting.full.x(),
                            (kSide * j + 0.5 * shift) * parting.full.y(), parting.apart * m);
      }
  // A plane away is as easy as half of a half length, or of a half width, away.
  const Vec3 easy(parting.full.x() / 2, parting.full.y() / 2, parting.apart);
  std::stable_sort(places.begin(), places.end(), [&](const Vec3& a, const Vec3& b) {
    return a.cwiseQuotient(easy).squaredNorm() < b.cwiseQuotient(easy).squaredNorm();
  });
  return places;
}

/// Keeps it within the walls along and beside the fibres, shifted by at most `slide` of a half
/// length or width. False where its middle is outside, or there is too little room.
bool fit_between(const Walls& walls, double slide, Bolus& bolus) {
  constexpr double kFilm = 0.3e-3;  // m of tissue above and below
  constexpr double kShare = 0.9;    // of the way to a wall, which is pushed on
  constexpr double kLeast = 0.35;   // of a full one's length and width
  const Vec3 up = bolus.axes.col(2);
  for (const Vec3& way : {up, Vec3(-up)}) {
    const double room = walls.reach(bolus.centre, way);
    if (room < kFilm || room == Walls::kFarAway) return false;
  }
  for (const int k : {0, 1}) {
    const Vec3 way = bolus.axes.col(k);
    const double ahead = kShare * walls.reach(bolus.centre, way);
    const double behind = kShare * walls.reach(bolus.centre, -way);
    double& half = bolus.proportion[k];
    const double least = kLeast * half;
    half = std::min(half, (ahead + behind) / 2);
    const double most = slide * std::max(half, least);
    const double shift = std::clamp(std::clamp(0.0, half - behind, ahead - half), -most, most);
    half = std::max(least, std::min({half, ahead - shift, behind + shift}));
    if (std::min(ahead - shift, behind + shift) < least) return false;
    bolus.centre += shift * way;
  }
  return true;
}

/// Opens one as region `number`, and takes the centres of `later` along.
void open_bolus(CompiledJoint& with, const Bolus& bolus, RegionId number, std::span<Bolus> later) {
  const Sphere unit = make_sphere();
  const double scale = std::cbrt(bolus.volume / (unit.volume * bolus.proportion.prod()));
  const Eigen::Matrix3d out = bolus.axes * (scale * bolus.proportion).asDiagonal();
  const Eigen::Matrix3d in = out.inverse();
  refine_beside(with, in, bolus.centre);
  const auto push = [&](Vec3& p) {
    const Vec3 y = in * (p - bolus.centre);
    const double rho = y.norm();
    if (rho < 1e-9)
      p = bolus.centre + out.col(0);
    else
      p = bolus.centre + out * (std::cbrt(1 + 1 / (rho * rho * rho)) * y);
  };
  for (Vec3& p : with.mesh.vertices) push(p);
  for (std::size_t k = 0; k + 1 < later.size(); ++k)
    push(later[k].centre);  // the last is the tip's
  const auto first = static_cast<std::uint32_t>(with.mesh.vertices.size());
  for (const Vec3& p : unit.points) with.mesh.vertices.push_back(bolus.centre + out * p);
  for (const auto& [a, b, c] : unit.triangles) {
    Interface f;
    f.vertices = {first + a, first + b, first + c};
    f.front = bolus.region;
    f.back = number;
    with.mesh.interfaces.push_back(f);
  }
}

}  // namespace

std::vector<Bolus> make_boluses(const CompiledJoint& joint, RegionId region, const Vec3& tip,
                                double volume) {
  constexpr double kTipSlide = 0.6;  // so that the tip stays in its own
  constexpr double kSlide = 0.5;
  constexpr double kThickest = 0.5;  // half thickness against how far apart: what is between stays
  ARTUS_REQUIRE(volume > 0, "a volume above 0");
  bool fibrous = false;
  const Eigen::Matrix3d axes = axes_at(joint, region, tip, fibrous);
  const Parting parting = parting_of(joint, region, fibrous);
  std::vector<Bolus> boluses{{region, tip, axes, parting.full, volume}};
  if (!(parting.apart > 0)) {
    // No longer than fibres part; what does not fit goes aside.
    Vec3& full = boluses[0].proportion;
    const double side = std::sqrt(volume / (kBall * full.y() * full.z() * parting.longest));
    full.x() = std::min(full.x(), parting.longest / side);
    return boluses;
  }
  const Walls walls(joint, region);
  static_cast<void>(fit_between(walls, kTipSlide, boluses[0]));
  double held = boluses[0].volume = kBall * boluses[0].proportion.prod();
  for (const Vec3& place : places_of(parting)) {
    if (held >= volume) break;
    Bolus bolus{region, tip + axes * place, axes, parting.full, 0};
    bolus.axes = axes_at(joint, region, bolus.centre, fibrous);
    if (!fit_between(walls, kSlide, bolus)) continue;
    bolus.volume = kBall * bolus.proportion.prod();
    held += bolus.volume;
    boluses.push_back(bolus);
  }
  if (held > volume) {
    boluses.back().volume -= held - volume;
  } else {  // no room for more: all become thicker, then wider and longer, as walls give way
    const double growth = volume / held;
    const double thicker = std::min(growth, kThickest * parting.apart / parting.full.z());
    const double wider = std::sqrt(growth / thicker);
    for (Bolus& bolus : boluses) {
      bolus.volume *= growth;
      bolus.proportion = bolus.proportion.cwiseProduct(Vec3(wider, wider, thicker));
    }
  }
  std::reverse(boluses.begin(), boluses.end());
  return boluses;
}

CompiledJoint with_boluses(const CompiledJoint& joint, std::vector<Bolus> boluses,
                           const Liquid& liquid) {
  CompiledJoint with = joint;
  const auto number = static_cast<RegionId>(with.regions.size());
  with.regions.push_back({"injected", liquid_tissue(with, liquid), Vec3::Zero()});
  for (std::size_t k = 0; k < boluses.size(); ++k) {
    ARTUS_REQUIRE(boluses[k].volume > 0, "a volume above 0");
    open_bolus(with, boluses[k], number, std::span(boluses).subspan(k + 1));
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
               : with_boluses(with, make_boluses(with, region, place.tip, place.volume), liquid);
  }
  return with;
}

}  // namespace artus
