// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/soft/liquid/injected_body.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <span>
#include <utility>

#include <Eigen/Eigenvalues>

#include "artus/detail/core/check.h"
#include "artus/detail/core/closest_point.h"
#include "artus/detail/core/noise.h"
#include "artus/detail/soft/liquid/bolus_opening.h"
#include "artus/detail/soft/liquid/overflow.h"

namespace artus {
namespace {

constexpr double kVisible = 1e-9;        // m^3
constexpr double kLongestSplit = 15e-3;  // m, half of the length; 10 to 30 mm in all, assumed
constexpr double kLeastRoom = 0.05e-6;   // m^3 that any tissue has room for; assumed
constexpr double kMinPressure = 500;     // Pa of a space's liquid: what lies on it; assumed
constexpr double kBall = 4 * std::numbers::pi / 3;

/// m from p to the nearest of the surfaces that `counts`; infinite where there is none.
template <class Counts>
Vec3 to_nearest(const CompiledJoint& joint, const Vec3& p, const Counts& counts) {
  const auto& v = joint.mesh.vertices;
  double least = std::numeric_limits<double>::infinity();
  Vec3 to = Vec3::Constant(least);
  for (const Interface& f : joint.mesh.interfaces) {
    if (!counts(f)) continue;
    const std::array<Vec3, 3> t{v[f.vertices[0]], v[f.vertices[1]], v[f.vertices[2]]};
    const double reach = std::max((t[1] - t[0]).norm(), (t[2] - t[0]).norm());
    if ((t[0] - p).norm() - reach >= least) continue;
    const Vec3 way = closest_point_on_triangle(p, t) - p;
    if (way.norm() >= least) continue;
    least = way.norm();
    to = way;
  }
  return to;
}

/// The nearest of the skin.
Vec3 to_skin(const CompiledJoint& joint, const Vec3& p) {
  return to_nearest(joint, p,
                    [](const Interface& f) { return f.front == kOutside || f.back == kOutside; });
}

Vec3 to_bone(const CompiledJoint& joint, const Vec3& p) {
  return to_nearest(joint, p, [&joint](const Interface& f) {
    return joint.tissue_of(f.front).haptic.hard != joint.tissue_of(f.back).haptic.hard;
  });
}

/// Unit; z where there is no way.
Vec3 direction_of(const Vec3& way) {
  return way.allFinite() && way.norm() > 0 ? way.normalized() : Vec3::UnitZ();
}

/// Unit, toward the skin, to which `skin` leads: across what is nearest, skin or bone, since liquid
/// spreads along both. Between them it turns by 1/distance^2.
Vec3 across_layers(const CompiledJoint& joint, const Vec3& p, const Vec3& skin) {
  constexpr double kOnIt = 1e-6;  // m
  Eigen::Matrix3d across = Eigen::Matrix3d::Zero();
  for (const Vec3& way : {skin, to_bone(joint, p)})
    if (way.allFinite() && way.norm() > kOnIt)
      across += way * way.transpose() / (way.squaredNorm() * way.squaredNorm());
  if (across.isZero()) return direction_of(skin);
  const Vec3 axis = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(across).eigenvectors().col(2);
  return direction_of(skin).dot(axis) < 0 ? Vec3(-axis) : axis;
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
struct BevelFlow {
  Vec3 full = Vec3::Ones();  // m, semi-axes of one that is full: along fibres, beside, toward skin
  double longest = 1;        // m, half of a length
  double apart = 0;          // m between the planes of two; 0: one opens alone
  int rows = 0;              // of them behind each other along the fibres, to either side
  double ragged = 0;         // of an outline
  double uneven = 0;         // by which lengths and widths differ from a full one's, of it
  bool lens = false;         // of a tissue without fibres: what it has no room for spreads in it
};

BevelFlow bevel_flow_of(const CompiledJoint& joint, RegionId region, bool fibrous) {
  const TissueKind kind = joint.tissue_of(region).acoustic.kind;
  if (kind == TissueKind::muscle) return {Vec3(10e-3, 5e-3, 0.7e-3), 1, 2e-3, 1, 0.2, 0.3};
  if (kind == TissueKind::nerve) return {Vec3(8e-3, 3e-3, 0.5e-3), kLongestSplit, 0, 0};
  if (fibrous) return {Vec3(12e-3, 8e-3, 0.6e-3), kLongestSplit, 1.5e-3, 0, 0.1, 0.2};
  return {Vec3(4e-3, 4e-3, 1e-3), 1, 0, 0, 0, 0, true};
}

/// Unit, in columns: along the fibres, beside them, toward the skin; without fibres across the
/// layers. A region has one axis for all of its fibres; near the skin they run along it.
Eigen::Matrix3d axes_at(const CompiledJoint& joint, RegionId region, const Vec3& p, bool& fibrous) {
  const Vec3 to = to_skin(joint, p);
  const Vec3 skin = direction_of(to);
  Vec3 along = joint.regions[region].fibre_axis;
  along -= along.dot(skin) * skin;
  fibrous = along.norm() > 0.1;
  const Vec3 across = fibrous ? skin : across_layers(joint, p, to);
  along = fibrous ? along.normalized() : across.unitOrthogonal();
  Vec3 up = across - across.dot(along) * along;
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
      const auto [at, leaves] = meet(wall, p, d);
      if (!(at > 0 && at < nearest)) continue;
      nearest = at;
      out = leaves;
    }
    return out ? nearest : 0;
  }
  /// m from wall to wall along d (unit) where the region is nearest to p on that line; 0: nowhere.
  [[nodiscard]] double width(const Vec3& p, const Vec3& d) const {
    std::vector<std::pair<double, bool>> met;
    for (const Wall& wall : walls_)
      if (const auto one = meet(wall, p, d); std::abs(one.first) < kFarAway) met.push_back(one);
    std::sort(met.begin(), met.end());
    double nearest = kFarAway;
    double width = 0;
    for (std::size_t k = 1; k < met.size(); ++k) {
      const double from = met[k - 1].first;
      const double to = met[k].first;
      const double away = std::max({0.0, from, -to});
      if (met[k - 1].second || !met[k].second || away >= nearest) continue;
      nearest = away;
      width = to - from;
    }
    return width;
  }

 private:
  struct Wall {
    Vec3 a;
    Vec3 ab;
    Vec3 ac;
    double outward;  // 1: its normal leads out of the region
  };
  /// m from p along d to a wall, kFarAway where the line misses it; whether it leaves the region.
  [[nodiscard]] static std::pair<double, bool> meet(const Wall& wall, const Vec3& p,
                                                    const Vec3& d) {
    const Vec3 normal = wall.ab.cross(wall.ac);
    const double facing = d.dot(normal);
    const double at = (wall.a - p).dot(normal) / facing;
    const Vec3 q = p + at * d - wall.a;
    const double whole = normal.squaredNorm();
    const double u = q.cross(wall.ac).dot(normal) / whole;
    const double v = wall.ab.cross(q).dot(normal) / whole;
    const bool met = u >= 0 && v >= 0 && u + v <= 1;
    return {met ? at : kFarAway, facing * wall.outward > 0};
  }
  std::vector<Wall> walls_;
};

/// Where liquid opens a tissue beside the tip, in the order of how far away, m along the tip's own
/// axes.
std::vector<Vec3> places_of(const BevelFlow& bevel_flow) {
  constexpr int kPlanes = 3;        // to either side of the tip's
  constexpr double kRow = 1.7;      // half lengths from one to the next along the fibres
  constexpr double kSide = 1.4;     // half widths beside them
  constexpr double kStagger = 0.4;  // half lengths by which planes are shifted, there and back
  std::vector<Vec3> places;
  if (!(bevel_flow.apart > 0)) return places;
  for (int m = -kPlanes; m <= kPlanes; ++m)
    for (int j = -1; j <= 1; ++j)
      for (int i = -bevel_flow.rows; i <= bevel_flow.rows; ++i) {
        if (m == 0 && j == 0 && i == 0) continue;
        const double shift = m % 2 == 0 ? 0 : (m > 0 ? kStagger : -kStagger);
        places.emplace_back((kRow * i + shift) * bevel_flow.full.x(),
                            (kSide * j + 0.5 * shift) * bevel_flow.full.y(), bevel_flow.apart * m);
      }
  // A plane away is as easy as half of a half length, or of a half width, away.
  const Vec3 easy(bevel_flow.full.x() / 2, bevel_flow.full.y() / 2, bevel_flow.apart);
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
  constexpr double kMin = 0.35;     // of a full one's length and width
  const Vec3 up = bolus.axes.col(2);
  for (const Vec3& direction : {up, Vec3(-up)}) {
    const double room = walls.reach(bolus.centre, direction);
    if (room < kFilm || room == Walls::kFarAway) return false;
  }
  for (const int k : {0, 1}) {
    const Vec3 direction = bolus.axes.col(k);
    const double ahead = kShare * walls.reach(bolus.centre, direction);
    const double behind = kShare * walls.reach(bolus.centre, -direction);
    double& half = bolus.proportion[k];
    const double least = kMin * half;
    half = std::min(half, (ahead + behind) / 2);
    const double most = slide * std::max(half, least);
    const double shift = std::clamp(std::clamp(0.0, half - behind, ahead - half), -most, most);
    half = std::max(least, std::min({half, ahead - shift, behind + shift}));
    if (std::min(ahead - shift, behind + shift) < least) return false;
    bolus.centre += shift * direction;
  }
  return true;
}

/// The middle of a lens whose tip is at its centre: where bone is nearer than the lens is thick it
/// lies on the bone, as far as the region reaches, so that it does not go around it.
Vec3 off_bone(const CompiledJoint& joint, const Bolus& lens) {
  constexpr double kOfRegion = 0.5;  // of its way on
  const Vec3 bone = to_bone(joint, lens.centre);
  const double lift = lens.semi_axes().z() - bone.norm();
  if (!(lift > 0) || !(bone.norm() > 0)) return lens.centre;
  const Vec3 away = -bone.normalized();
  const double room = Walls(joint, lens.region).reach(lens.centre, away);
  return lens.centre + std::min(lift, kOfRegion * room) * away;
}

}  // namespace

Vec3 Bolus::semi_axes() const {
  return std::cbrt(volume / (kBall * proportion.prod())) * proportion;
}

std::vector<Bolus> make_boluses(const CompiledJoint& joint, RegionId region, const Vec3& tip,
                                double volume) {
  constexpr double kTipSlide = 0.6;  // so that the tip stays in its own
  constexpr double kSlide = 0.5;
  constexpr double kThickest = 0.5;  // half thickness against how far apart: what is between stays
  ARTUS_REQUIRE(volume > 0, "a volume above 0");
  bool fibrous = false;
  const Eigen::Matrix3d axes = axes_at(joint, region, tip, fibrous);
  const BevelFlow bevel_flow = bevel_flow_of(joint, region, fibrous);
  std::vector<Bolus> boluses{{region, tip, axes, bevel_flow.full, volume, bevel_flow.ragged, 0}};
  if (!(bevel_flow.apart > 0)) {
    // No longer than fibres part; what does not fit goes aside.
    Vec3& full = boluses[0].proportion;
    const double side = std::sqrt(volume / (kBall * full.y() * full.z() * bevel_flow.longest));
    full.x() = std::min(full.x(), bevel_flow.longest / side);
    if (bevel_flow.lens) boluses[0].centre = off_bone(joint, boluses[0]);
    return boluses;
  }
  const Walls walls(joint, region);
  static_cast<void>(fit_between(walls, kTipSlide, boluses[0]));
  double held = boluses[0].volume = kBall * boluses[0].proportion.prod();
  std::uint64_t number = 0;
  for (const Vec3& place : places_of(bevel_flow)) {
    if (held >= volume) break;
    Bolus bolus{region, tip + axes * place, axes, bevel_flow.full, 0, bevel_flow.ragged, ++number};
    for (const int k : {0, 1})
      bolus.proportion[k] *= 1 + bevel_flow.uneven * (2 * uniform_noise(number, 1000 + k) - 1);
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
    const double thicker = std::min(growth, kThickest * bevel_flow.apart / bevel_flow.full.z());
    const double wider = std::sqrt(growth / thicker);
    for (Bolus& bolus : boluses) {
      bolus.volume *= growth;
      bolus.proportion = bolus.proportion.cwiseProduct(Vec3(wider, wider, thicker));
    }
  }
  std::reverse(boluses.begin(), boluses.end());
  return boluses;
}

double room_at(const CompiledJoint& joint, RegionId region, const Vec3& tip) {
  bool fibrous = false;
  static_cast<void>(axes_at(joint, region, tip, fibrous));
  const BevelFlow bevel_flow = bevel_flow_of(joint, region, fibrous);
  double thickness = std::numeric_limits<double>::infinity();
  if (!bevel_flow.lens) return thickness;
  const Walls walls(joint, region);
  for (int k = 0; k < 13; ++k) {  // directions to a cube's middles, edges and corners
    const Vec3 d = Vec3(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1).normalized();
    if (const double width = walls.width(tip, d); width > 0) thickness = std::min(thickness, width);
  }
  const double side = thickness / 2 / bevel_flow.full.z();
  return std::max(kLeastRoom, kBall * bevel_flow.full.prod() * side * side * side);
}

CompiledJoint with_boluses(const CompiledJoint& joint, std::vector<Bolus> boluses,
                           const Liquid& liquid) {
  CompiledJoint with = joint;
  const auto number = static_cast<RegionId>(with.regions.size());
  with.regions.push_back({"injected", liquid_tissue(with, liquid), Vec3::Zero()});
  ARTUS_REQUIRE(!boluses.empty(), "something to open");
  BolusOpening opening(with, number);
  const Vec3 tip = boluses.back().centre;
  for (std::size_t k = 0; k < boluses.size(); ++k) {
    ARTUS_REQUIRE(boluses[k].volume > 0, "a volume above 0");
    // The tip does not go along with what is pushed; where liquid has come to it, that will do.
    if (k + 1 == boluses.size() && !opening.is_liquid(tip)) boluses[k].centre = tip;
    opening.open(boluses[k], std::span(boluses).subspan(k + 1));
  }
  return with;
}

namespace {

/// A space and what is put into it, of all places that it has.
struct Filled {
  const OpenedSpace* space;
  OpenedSpace::Filling filling;
};

/// One after another. What opens later gives to those before it, or takes from them, next to
/// nothing of their volume; that is made up for.
void open_spaces(std::vector<Filled>& filled, TetMesh& mesh) {
  constexpr int kRounds = 6;
  constexpr double kExact = 1e-9;  // of a volume
  const TetMesh rest = mesh;
  const std::vector<Filled> wanted = filled;
  for (int round = 0; round < kRounds; ++round) {
    mesh.vertices = rest.vertices;
    for (const Filled& f : filled) mesh.vertices = f.space->vertices(mesh, f.filling);
    bool exact = true;
    for (std::size_t k = 0; k + 1 < filled.size(); ++k) {
      const double volume = wanted[k].filling.volume;
      const double off =
          filled[k].space->volume_in(mesh) - filled[k].space->volume_in(rest) - volume;
      if (std::abs(off) <= kExact * volume) continue;
      exact = false;
      filled[k].filling.volume = std::max(0.0, filled[k].filling.volume - off);
    }
    if (exact) return;
  }
}

}  // namespace

CompiledJoint with_injected(const CompiledJoint& joint, const std::vector<Injected>& given,
                            const Liquid& liquid, const StressAt& stress,
                            const OpenedSpaces& spaces) {
  const std::vector<Injected> places = with_overflow(spaces, given);
  CompiledJoint with = joint;
  std::vector<Filled> filled;
  // Tissue first: where it is parted is told of the body at rest, and is lifted with what opens.
  for (const bool cavity : {false, true})
    for (const Injected& place : places) {
      const auto at = std::find_if(joint.regions.begin(), joint.regions.end(),
                                   [&](const Region& r) { return r.name == place.region; });
      if (at == joint.regions.end() || !(place.volume >= kVisible) || place.cavity != cavity)
        continue;
      const auto region = static_cast<RegionId>(at - joint.regions.begin());
      if (region < kFirstRegion) continue;
      if (!cavity) {
        with = with_boluses(with, make_boluses(with, region, place.tip, place.more * place.volume),
                            liquid);
        continue;
      }
      const OpenedSpace* space = &spaces.of(region);
      const auto known = std::find_if(filled.begin(), filled.end(),
                                      [&](const Filled& f) { return f.space == space; });
      if (known != filled.end()) {
        known->filling.volume += place.more * place.volume;
        continue;
      }
      OpenedSpace::Press press;
      if (stress)
        press = [&stress, whole = std::max(place.pressure, kMinPressure)](const Vec3& p) {
          return stress(p) / whole;
        };
      filled.push_back({space, {place.tip, place.more * place.volume, press}});
    }
  open_spaces(filled, with.mesh);
  if (filled.empty()) return with;
  const TissueId tissue = liquid_tissue(with, liquid);
  for (const Filled& f : filled)
    for (const RegionId region : f.space->regions()) with.regions[region].tissue = tissue;
  return with;
}

CompiledJoint with_injected(const CompiledJoint& joint, const std::vector<Injected>& places,
                            const Liquid& liquid, const StressAt& stress) {
  const OpenedSpaces spaces(std::make_shared<const CompiledJoint>(joint));
  return with_injected(joint, places, liquid, stress, spaces);
}

}  // namespace artus
