// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/soft/liquid/opened_space.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <utility>

#include <boost/math/tools/roots.hpp>

#include "artus/detail/core/check.h"
#include "artus/detail/core/disjoint_sets.h"
#include "artus/detail/soft/liquid/lens.h"
#include "artus/detail/soft/liquid/space_walls.h"
#include "artus/detail/soft/liquid/unfolded.h"

namespace artus {
namespace {

constexpr double kThickest = 5e-3;  // m, above which it spreads as long as there is room; assumed
constexpr double kSpread = 1.2;     // of its radius, from one try to the next
constexpr int kHalvings = 20;
constexpr double kMylar = 1.2185;  // of a disc's radius cubed
constexpr double kStretched = 1.25;
constexpr double kAllOpen = 2;     // extents of a space beyond which a patch is all of it
constexpr double kConfined = 0.5;  // the same, of a patch that feels the rim all around
constexpr double kSlope = 0.5;     // by which a step may turn or stretch at most
constexpr int kMaxSteps = 256;
constexpr int kMaxTries = 60;
constexpr int kBackPasses = 40;
constexpr double kExactBack = 1e-12;  // m
constexpr int kSmoothings = 60;
constexpr double kSteepestPatch = 1.55;  // of (1 - q^2)^2, per q
constexpr double kExactPress = 1e-3;     // of how a press is carried on into tissue
constexpr double kMargin = 1.3;          // of a first guess at how long the flow is

/// Of the square of a distance, in reaches.
double profile(double square) {
  return square < 1 ? (1 - square) * (1 - square) : 0;
}

}  // namespace

OpenedSpace::OpenedSpace(const CompiledJoint& joint, std::vector<RegionId> regions,
                         const std::atomic<bool>* stop)
    : regions_(std::move(regions)),
      mesh_(joint.mesh),
      cage_(joint, regions_),
      field_(joint, cage_, stop) {
  for (RegionId r = 0; r < joint.regions.size(); ++r)
    hard_.push_back(joint.tissue_of(r).haptic.hard);
  in_.assign(joint.regions.size(), false);
  for (const RegionId r : regions_) in_[r] = true;
  find_places();
}

void OpenedSpace::find_places() {
  const std::vector<Vec3>& p = mesh_.vertices;
  std::vector<Vec3> into(p.size(), Vec3::Zero());
  std::vector<bool> on_wall(p.size(), false);
  for (const auto& [a, b, c] : walls_of(mesh_, in_))
    for (const std::uint32_t v : {a, b, c}) {
      into[v] += (p[b] - p[a]).cross(p[c] - p[a]);
      on_wall[v] = true;
    }
  inside_.assign(p.size(), false);
  const auto mark = [&](std::uint32_t v) {
    if (!on_wall[v]) inside_[v] = true;
  };
  for (const Interface& f : mesh_.interfaces)
    if (is_in(f.front) && is_in(f.back))
      for (const std::uint32_t v : f.vertices) mark(v);
  for (std::size_t t = 0; t < mesh_.tetrahedra.size(); ++t)
    if (is_in(mesh_.regions[t]))
      for (const std::uint32_t v : mesh_.tetrahedra[t]) mark(v);
  edges_ = edges_inside(mesh_);
  for (const SidedCage::Wall& wall : cage_.walls())
    wall_places_.push_back(cage_.locate((wall.p[0] + wall.p[1] + wall.p[2]) / 3, wall.into));
  places_.resize(p.size());
  for (std::size_t i = 0; i < p.size(); ++i)
    places_[i] = inside_[i] ? SidedCage::Place{p[i], -1} : cage_.locate(p[i], into[i]);
}

/// What was cut finer lies in the tissue of what it was cut from.
std::vector<SidedCage::Place> OpenedSpace::places_in(const TetMesh& mesh) const {
  std::vector<SidedCage::Place> places = places_;
  for (std::size_t i = 0; i < places.size(); ++i) cage_.carry(places[i], mesh.vertices[i]);
  const std::size_t n = places.size();
  if (mesh.vertices.size() == n) return places;
  places.resize(mesh.vertices.size());
  std::vector<bool> known(places.size(), false);
  std::fill(known.begin(), known.begin() + static_cast<std::ptrdiff_t>(n), true);
  for (bool more = true; more;) {
    more = false;
    for (const Interface& f : mesh.interfaces)
      for (const std::uint32_t v : f.vertices) {
        if (known[v]) continue;
        for (const std::uint32_t from : f.vertices) {
          if (!known[from] || places[from].copy < 0) continue;
          places[v] = places[from];
          cage_.carry(places[v], mesh.vertices[v]);
          more = known[v] = true;
          break;
        }
      }
  }
  place_boluses(mesh, known, places);
  return places;
}

/// What was parted has walls that hang together with nothing else, and pushes the space's walls
/// aside: all of it belongs to the tissue that its middle is in.
void OpenedSpace::place_boluses(const TetMesh& mesh, std::vector<bool>& known,
                                std::vector<SidedCage::Place>& places) const {
  DisjointSets walls(places.size());
  for (const Interface& f : mesh.interfaces) {
    if (known[f.vertices[0]] || known[f.vertices[1]] || known[f.vertices[2]]) continue;
    for (const std::uint32_t v : {f.vertices[1], f.vertices[2]}) walls.join(f.vertices[0], v);
  }
  std::map<std::uint32_t, std::vector<std::uint32_t>> boluses;
  for (std::uint32_t i = 0; i < places.size(); ++i)
    if (!known[i]) boluses[walls.find(i)].push_back(i);
  for (const auto& [corner, vertices] : boluses) {
    Vec3 middle = Vec3::Zero();
    for (const std::uint32_t v : vertices) middle += mesh.vertices[v];
    const SidedCage::Place place =
        cage_.locate(middle / static_cast<double>(vertices.size()), Vec3::Zero());
    for (const std::uint32_t v : vertices) {
      places[v] = place;
      cage_.carry(places[v], mesh.vertices[v]);
      known[v] = true;
    }
  }
}

Vec3 OpenedSpace::Flow::velocity(const SidedCage::Place& place) const {
  if (place.copy < 0) return Vec3::Zero();
  const auto weights = cage_->weights(place);
  const auto& at = cage_->copies()[static_cast<std::size_t>(place.copy)].nodes;
  Vec3 motion = Vec3::Zero();
  double from = 0;
  double press = 0;
  for (std::size_t k = 0; k < 8; ++k) {
    const Node& node = nodes_[at[k]];
    motion += weights[k] * node.motion;
    from += weights[k] * node.from;
    press += weights[k] * node.press;
  }
  return profile(from / (reach_ * reach_)) * std::max(0.0, lambda_ - press) * motion;
}

SidedCage::Place OpenedSpace::Flow::place_of(const Vec3& p, const Vec3& into) const {
  return cage_->locate(p, into);
}

/// Midpoints, so short that each step is one to one.
SidedCage::Place OpenedSpace::Flow::forth(SidedCage::Place place) const {
  const double step = length_ / steps_;
  for (int k = 0; k < steps_; ++k) {
    const Vec3 first = velocity(place);
    if (first.isZero(0)) return place;
    SidedCage::Place middle = place;
    cage_->carry(middle, place.p + step / 2 * first);
    cage_->carry(place, place.p + step * velocity(middle));
  }
  return place;
}

SidedCage::Place OpenedSpace::Flow::back(SidedCage::Place place) const {
  const double step = length_ / steps_;
  for (int k = 0; k < steps_; ++k) {
    SidedCage::Place from = place;
    for (int pass = 0; pass < kBackPasses; ++pass) {
      SidedCage::Place middle = from;
      cage_->carry(middle, from.p + step / 2 * velocity(from));
      const Vec3 next = place.p - step * velocity(middle);
      const double moved = (next - from.p).norm();
      cage_->carry(from, next);
      if (moved < kExactBack) break;
    }
    place = from;
  }
  return place;
}

/// m by which the walls go apart where they do so most, to first order.
double OpenedSpace::thickness(const Flow& flow, double volume) const {
  double rate = 0;
  double most = 0;
  for (std::size_t k = 0; k < wall_places_.size(); ++k) {
    const SidedCage::Wall& wall = cage_.walls()[k];
    const Vec3 v = flow.velocity(wall_places_[k]);
    rate += v.dot((wall.p[1] - wall.p[0]).cross(wall.p[2] - wall.p[0]).norm() / 2 * wall.into);
    most = std::max(most, v.norm());
  }
  return rate > 0 ? volume / rate * most : std::numeric_limits<double>::infinity();
}

/// Wide enough that nowhere it is thicker than kThickest, as far as there is room.
double OpenedSpace::reach_of(const Flow& flow, double volume) const {
  Flow tried = flow;
  const auto thick = [&](double reach) {
    tried.reach_ = reach;
    return thickness(tried, volume);
  };
  const double narrow = lens_radius(volume);
  const double wide = kAllOpen * cage_.extent();
  if (narrow >= wide || thick(narrow) <= kThickest) return narrow;
  double low = narrow;
  double high = std::min(kSpread * low, wide);
  for (; high < wide && thick(high) > kThickest; high = std::min(kSpread * high, wide)) low = high;
  if (thick(high) > kThickest) return high;
  for (int k = 0; k < kHalvings; ++k) {
    const double middle = (low + high) / 2;
    (thick(middle) > kThickest ? low : high) = middle;
  }
  return high;
}

int OpenedSpace::steps_for(const Flow& flow) const {
  double steepest = 0;
  double fastest = 0;
  for (const SidedCage::Copy& copy : cage_.copies())
    for (std::size_t i = 0; i < 8; ++i) {
      fastest = std::max(fastest, flow.nodes_[copy.nodes[i]].motion.norm());
      for (std::size_t a = 0; a < 3; ++a) {
        const Vec3 change = flow.nodes_[copy.nodes[i ^ (std::size_t{1} << a)]].motion -
                            flow.nodes_[copy.nodes[i]].motion;
        steepest = std::max(steepest, change.norm() / cage_.edge());
      }
    }
  steepest += kSteepestPatch * fastest / flow.reach_;
  const double n = std::ceil(kMargin * flow.length_ * steepest / kSlope);
  return static_cast<int>(std::clamp(n, 2.0, static_cast<double>(kMaxSteps)));
}

/// Each corner once.
static std::vector<std::uint32_t> corners_of(const std::vector<WallTriangle>& walls) {
  std::vector<std::uint32_t> corners;
  for (const auto& wall : walls) corners.insert(corners.end(), wall.begin(), wall.end());
  std::sort(corners.begin(), corners.end());
  corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
  return corners;
}

OpenedSpace::Flow OpenedSpace::flow_in(const TetMesh& mesh,
                                       std::span<const SidedCage::Place> places,
                                       const Filling& filling) const {
  ARTUS_REQUIRE(filling.volume >= 0, "a volume of at least 0");
  Flow flow;
  flow.cage_ = &cage_;
  flow.reach_ = 1;
  flow.nodes_.resize(cage_.n_nodes());
  for (std::size_t i = 0; i < flow.nodes_.size(); ++i) flow.nodes_[i].motion = field_.motion()[i];
  if (!(filling.volume > 0)) return flow;
  const std::vector<double> from = field_.squared_distance(filling.tip);
  for (std::size_t i = 0; i < flow.nodes_.size(); ++i) flow.nodes_[i].from = from[i];
  flow.reach_ = reach_of(flow, filling.volume);
  const std::vector<WallTriangle> walls = walls_of(mesh, in_);
  const std::vector<std::uint32_t> moving = corners_of(walls);
  std::vector<Vec3> moved = mesh.vertices;
  const auto held = [&] {
    return volume_within(walls, moved, filling.tip);
  };
  const double rest = held();
  double rate = 0;  // m^3/Pa
  for (const auto& [a, b, c] : walls) {
    const Vec3 area = (moved[b] - moved[a]).cross(moved[c] - moved[a]) / 6;
    for (const std::uint32_t v : {a, b, c}) rate += area.dot(flow.velocity(places[v]));
  }
  if (!(rate > 0)) return flow;  // nothing gives way
  const auto more_with = [&](double& changed, double value) {
    changed = value;
    for (const std::uint32_t v : moving) moved[v] = flow.forth(places[v]).p;
    return held() - rest - filling.volume;
  };
  const auto find = [&](double& changed, double high) {
    double at_high = more_with(changed, high);
    for (int k = 0; k < kMaxTries && at_high < 0; ++k) at_high = more_with(changed, high *= 1.5);
    if (at_high < 0) return;
    std::uintmax_t tries = kMaxTries;
    const auto [low, up] = boost::math::tools::toms748_solve(
        [&](double value) { return value > 0 ? more_with(changed, value) : -filling.volume; }, 0.0,
        high, -filling.volume, at_high, boost::math::tools::eps_tolerance<double>(50), tries);
    const double off = more_with(changed, low);
    if (std::abs(more_with(changed, up)) > std::abs(off)) changed = low;
  };
  flow.length_ = filling.volume / rate;
  flow.steps_ = steps_for(flow);
  find(flow.length_, flow.length_);
  if (!filling.press) return flow;
  const auto press = field_.carry_on(filling.press, kExactPress);
  double most = 0;
  for (std::size_t i = 0; i < flow.nodes_.size(); ++i) {
    flow.nodes_[i].press = std::max(press[i], 0.0);
    most = std::max(most, flow.nodes_[i].press);
  }
  flow.steps_ = std::min(2 * flow.steps_, kMaxSteps);
  find(flow.lambda_, 1 + most);
  return flow;
}

std::vector<Vec3> OpenedSpace::vertices(const TetMesh& mesh, const Filling& filling) const {
  ARTUS_REQUIRE(mesh.vertices.size() >= places_.size(), "the joint's mesh");
  const std::vector<SidedCage::Place> places = places_in(mesh);
  const Flow flow = flow_in(mesh, places, filling);
  std::vector<Vec3> moved = mesh.vertices;
  if (!(flow.length_ > 0)) return moved;
  std::vector<bool> held =
      held_in(mesh);  // exactly: a vertex on the face of a cube that moves, too
  for (std::size_t i = 0; i < moved.size(); ++i)
    if (places[i].copy >= 0 && !held[i]) moved[i] = flow.forth(places[i]).p;
  put_right(mesh, std::move(held), moved);
  fill_inside(mesh, moved);
  return moved;
}

/// Vertices of bone.
std::vector<bool> OpenedSpace::held_in(const TetMesh& mesh) const {
  std::vector<bool> held(mesh.vertices.size(), false);
  const auto hold = [&](RegionId region, const auto& vertices) {
    if (region < hard_.size() && hard_[region])
      for (const std::uint32_t v : vertices) held[v] = true;
  };
  for (const Interface& f : mesh.interfaces)
    for (const RegionId region : {f.front, f.back}) hold(region, f.vertices);
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t)
    hold(mesh.regions[t], mesh.tetrahedra[t]);
  return held;
}

/// What the flow turns over.
void OpenedSpace::put_right(const TetMesh& mesh, std::vector<bool> held,
                            std::vector<Vec3>& moved) const {
  Unfolding unfolding;
  unfolding.held = std::move(held);
  unfolding.loose.assign(hard_.size() + 1, false);  // and what was parted
  unfolding.loose.back() = true;
  for (const RegionId region : regions_) unfolding.loose[region] = true;
  unfolding.walls = walls_of(mesh_, in_);
  unfolding.finer = walls_of(mesh, in_);
  unfold(mesh, unfolding, moved);
}

/// What the space has between its walls goes along with them, drawn out evenly.
void OpenedSpace::fill_inside(const TetMesh& mesh, std::vector<Vec3>& moved) const {
  const bool same = mesh.interfaces.size() == mesh_.interfaces.size();
  const std::vector<Edge> edges = same ? std::vector<Edge>() : edges_inside(mesh);
  smooth(same ? edges_ : edges, mesh, moved);
}

/// From a vertex between the walls to one beside it, in order.
std::vector<OpenedSpace::Edge> OpenedSpace::edges_inside(const TetMesh& mesh) const {
  std::vector<Edge> edges;
  const auto add = [&](std::uint32_t a, std::uint32_t b) {
    if (a < inside_.size() && inside_[a]) edges.emplace_back(a, b);
    if (b < inside_.size() && inside_[b]) edges.emplace_back(b, a);
  };
  for (const Interface& f : mesh.interfaces)
    if (is_in(f.front) && is_in(f.back))
      for (std::size_t k = 0; k < 3; ++k) add(f.vertices[k], f.vertices[(k + 1) % 3]);
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t)
    if (is_in(mesh.regions[t]))
      for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = i + 1; j < 4; ++j) add(mesh.tetrahedra[t][i], mesh.tetrahedra[t][j]);
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  return edges;
}

void OpenedSpace::smooth(std::span<const Edge> edges, const TetMesh& mesh,
                         std::vector<Vec3>& moved) {
  for (int pass = 0; pass < kSmoothings; ++pass)
    for (std::size_t k = 0; k < edges.size();) {
      const std::uint32_t v = edges[k].first;
      Vec3 sum = Vec3::Zero();
      double n = 0;
      for (; k < edges.size() && edges[k].first == v; ++k, n += 1)
        sum += moved[edges[k].second] - mesh.vertices[edges[k].second];
      moved[v] = mesh.vertices[v] + sum / n;
    }
}

double OpenedSpace::rest_volume() const {
  return volume_within(walls_of(mesh_, in_), mesh_.vertices);
}

double OpenedSpace::volume_in(const TetMesh& mesh) const {
  return volume_within(walls_of(mesh, in_), mesh.vertices, mesh.vertices.front());
}

double OpenedSpace::max_volume() const {
  double area = 0;
  for (const SidedCage::Wall& wall : cage_.walls())
    area += (wall.p[1] - wall.p[0]).cross(wall.p[2] - wall.p[0]).norm() / 2;
  return kStretched * kMylar * std::pow(area / 2 / std::numbers::pi, 1.5);
}

/// Of the piece of wall that moves most, against the one that it faces.
double OpenedSpace::largest_opening(const Vec3& tip, double volume) const {
  const Flow moving = flow({tip, volume, {}});
  const auto walls = cage_.walls();
  std::vector<Vec3> moved;
  std::size_t most = 0;
  for (const SidedCage::Place& place : wall_places_) {
    moved.emplace_back(moving.forth(place).p - place.p);
    if (moved.back().norm() > moved[most].norm()) most = moved.size() - 1;
  }
  double nearest = std::numeric_limits<double>::infinity();
  Vec3 opposite = Vec3::Zero();
  for (std::size_t j = 0; j < walls.size(); ++j) {
    if (walls[j].into.dot(walls[most].into) > -0.5) continue;
    const double distance = (wall_places_[j].p - wall_places_[most].p).squaredNorm();
    if (distance >= nearest) continue;
    nearest = distance;
    opposite = moved[j];
  }
  return (moved[most] - opposite).norm();
}

bool OpenedSpace::confines(const Vec3& tip, double volume) const {
  return flow({tip, std::max(volume, 1e-12), {}}).reach_ > kConfined * cage_.extent();
}

}  // namespace artus
