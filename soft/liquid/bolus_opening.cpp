// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/soft/liquid/bolus_opening.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <utility>

#include "artus/detail/core/noise.h"
#include "artus/detail/soft/liquid/bone_shadow.h"

namespace artus {
namespace {

constexpr int kSubdivisions = 3;   // of an icosahedron
constexpr double kNearBone = 0.8;  // of the way to bone that liquid takes at most
constexpr double kFilm = 1.1;  // of its volume: tissue that facets of wall and liquid need between
constexpr double kExactVolume = 1e-16;  // m^3
constexpr int kSteps = 30;
constexpr double kMax = 1e4;  // times its volume that is drawn for what bone takes of it

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

/// Cuts interfaces at the middles of the edges that are too long for the map
/// beside the unit ball of `in`, so that they follow it: a wall of few
/// triangles would cut through the liquid. An edge is judged by its ends alone,
/// so neighbours agree.
void refine_beside(CompiledJoint& joint, const Eigen::Matrix3d& in, const Vec3& centre) {
  constexpr int kTimes = 10;
  constexpr double kFar = 3;      // radii beyond which the map hardly bends anything
  constexpr double kLong = 0.1;   // of an edge against its distance from the middle
  constexpr double kNear = 0.05;  // radii; closer to the middle edges need not be shorter for that
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

/// How far an outline reaches by direction, as a factor of the cube of its
/// radius: some waves of the directions, drawn by number.
class Outline {
 public:
  Outline(double ragged, std::uint64_t number) : ragged_(ragged) {
    for (std::size_t k = 0; k < kWaves; ++k) {
      const auto draw = [&](std::uint64_t i) {
        return normal_noise(number, 4 * k + i);
      };
      waves_[k] = kWaveNumber / std::sqrt(3.0) * Vec3(draw(0), draw(1), draw(2));
      phases_[k] = 2 * std::numbers::pi * uniform_noise(number, 4 * k + 3);
    }
  }
  [[nodiscard]] double reach(const Vec3& displacement) const {
    if (!(ragged_ > 0)) return 1;
    double sum = 0;
    for (std::size_t k = 0; k < kWaves; ++k)
      sum += std::sin(waves_[k].dot(displacement) + phases_[k]);
    return std::exp(ragged_ * sum);
  }

 private:
  static constexpr std::size_t kWaves = 4;
  static constexpr double kWaveNumber = 5;  // 1/rad, of a typical one; assumed
  double ragged_;
  std::array<Vec3, kWaves> waves_;
  std::array<double, kWaves> phases_{};
};

/// What one of them does to a point.
class Push {
 public:
  Push(const Bolus& bolus, double radius)
      : centre_(bolus.centre),
        out_(bolus.axes * (radius * bolus.proportion).asDiagonal()),
        in_(out_.inverse()),
        outline_(bolus.ragged, bolus.number) {}

  [[nodiscard]] const Vec3& centre() const noexcept { return centre_; }
  [[nodiscard]] const Eigen::Matrix3d& in() const noexcept { return in_; }
  /// The cube of the radius that it has where there is no bone.
  void set_cube(double cube) noexcept { cube_ = cube; }

  void see_bone(const CompiledJoint& body) {
    const auto& points = body.mesh.vertices;
    for (const Interface& f : body.mesh.interfaces) {
      if (!body.tissue_of(f.front).haptic.hard && !body.tissue_of(f.back).haptic.hard) continue;
      const auto& [a, b, c] = f.vertices;
      shadow_.add(
          {in_ * (points[a] - centre_), in_ * (points[b] - centre_), in_ * (points[c] - centre_)});
    }
    shadow_.spread();
  }

  /// The liquid's surface; `direction`: unit.
  [[nodiscard]] Vec3 surface(const Vec3& displacement) const {
    return centre_ + out_ * (std::cbrt(cube_toward(shadow_.nearness(displacement),
                                                   outline_.reach(displacement))) *
                             displacement);
  }

  [[nodiscard]] Vec3 moved(const Vec3& p) const {
    const Vec3 y = in_ * (p - centre_);
    const double rho = y.norm();
    if (rho < 1e-9) return surface(Vec3::UnitX());
    const bool is_far = rho >= BoneShadow::kFarthest;
    const double near = is_far ? 0 : shadow_.nearness(y);
    const double cube = rho * rho * rho;
    if (cube * near >= 1) return p;
    // From afar an outline looks smooth; evenly less over so long a path that
    // nothing passes.
    constexpr double kSmooth = 2;
    const double seen =
        std::clamp((BoneShadow::kFarthest - rho) / (BoneShadow::kFarthest - kSmooth), 0.0, 1.0);
    const double reach = is_far ? 1 : 1 + seen * (outline_.reach(y / rho) - 1);
    const double opened = kFilm * cube_toward(near, reach);
    return centre_ + out_ * (std::cbrt(opened / cube + 1 - opened * near) * y);
  }

 private:
  [[nodiscard]] double cube_toward(double near, double reach) const {
    const double cube = reach * cube_;
    return cube / (1 + cube * near / (kNearBone * kNearBone * kNearBone));
  }

  Vec3 centre_;
  Eigen::Matrix3d out_;
  Eigen::Matrix3d in_;
  Outline outline_;
  BoneShadow shadow_;
  double cube_ = 1;
};

/// What was opened before.
Sphere find_liquid(const TetMesh& mesh, RegionId number) {
  Sphere liquid;
  std::map<std::uint32_t, std::uint32_t> numbers;
  for (const Interface& f : mesh.interfaces) {
    if (f.back != number) continue;
    std::array<std::uint32_t, 3>& triangle = liquid.triangles.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [at, is_new] =
          numbers.try_emplace(f.vertices[k], static_cast<std::uint32_t>(liquid.points.size()));
      if (is_new) liquid.points.push_back(mesh.vertices[f.vertices[k]]);
      triangle[k] = at->second;
    }
  }
  return liquid;
}

/// m^3 of what was opened before, as it is pushed now, and of what is opened.
double liquid_volume(const Push& push, const Sphere& before, const Sphere& unit) {
  double six = 0;
  std::vector<Vec3> moved;
  const auto add = [&](const Sphere& s, const auto& place) {
    moved.clear();
    for (const Vec3& p : s.points) moved.push_back(place(p) - push.centre());
    for (const auto& [a, b, c] : s.triangles) six += moved[a].dot(moved[b].cross(moved[c]));
  };
  add(before, [&](const Vec3& p) { return push.moved(p); });
  add(unit, [&](const Vec3& p) { return push.surface(p); });
  return six / 6;
}

/// So that all liquid has the volume `wanted`, as far as bone leaves room for
/// it.
void find_cube(const Sphere& before, const Sphere& unit, double wanted, double own, Push& push) {
  const auto missing = [&](double cube) {
    push.set_cube(cube);
    return wanted - liquid_volume(push, before, unit);
  };
  double cube = 1;
  double now = missing(cube);
  double slope = own;  // m^3 for a cube of 1 more
  for (int k = 0; k < kSteps && std::abs(now) > kExactVolume; ++k) {
    const double next = std::clamp(cube + now / slope, cube / 2, std::min(2 * cube, kMax));
    if (next == cube) break;
    const double then = missing(next);
    slope = std::max((now - then) / (next - cube), own / kMax);
    cube = next;
    now = then;
  }
}

}  // namespace

BolusOpening::BolusOpening(CompiledJoint& body, RegionId number) : body_(body), number_(number) {}

/// By vertex, whether it is bone's.
std::vector<bool> BolusOpening::find_bone() const {
  std::vector<bool> bone(body_.mesh.vertices.size(), false);
  for (const Interface& f : body_.mesh.interfaces)
    if (body_.tissue_of(f.front).haptic.hard || body_.tissue_of(f.back).haptic.hard)
      for (const std::uint32_t v : f.vertices) bone[v] = true;
  return bone;
}

/// By the angle that all liquid fills as seen from there: none, or all around.
bool BolusOpening::is_liquid(const Vec3& p) const {
  const Sphere liquid = find_liquid(body_.mesh, number_);
  double half_angle = 0;
  for (const auto& [ia, ib, ic] : liquid.triangles) {
    const Vec3 a = (liquid.points[ia] - p).normalized();
    const Vec3 b = (liquid.points[ib] - p).normalized();
    const Vec3 c = (liquid.points[ic] - p).normalized();
    half_angle += std::atan2(a.dot(b.cross(c)), 1 + a.dot(b) + b.dot(c) + c.dot(a));
  }
  return std::abs(half_angle) > std::numbers::pi;
}

void BolusOpening::open(const Bolus& bolus, std::span<Bolus> later) {
  const Sphere unit = make_sphere();
  Push push(bolus, std::cbrt(bolus.volume / (unit.volume * bolus.proportion.prod())));
  refine_beside(body_, push.in(), push.centre());
  push.see_bone(body_);
  std::vector<Vec3>& points = body_.mesh.vertices;
  const Sphere before = find_liquid(body_.mesh, number_);
  wanted_ += bolus.volume;
  find_cube(before, unit, wanted_, bolus.volume, push);
  const std::vector<bool> bone = find_bone();
  for (std::size_t v = 0; v < points.size(); ++v)
    if (!bone[v]) points[v] = push.moved(points[v]);
  for (Bolus& next : later) next.centre = push.moved(next.centre);
  const auto first = static_cast<std::uint32_t>(points.size());
  for (const Vec3& p : unit.points) points.push_back(push.surface(p));
  for (const auto& [a, b, c] : unit.triangles) {
    Interface f;
    f.vertices = {first + a, first + b, first + c};
    f.front = bolus.region;
    f.back = number_;
    body_.mesh.interfaces.push_back(f);
  }
}

}  // namespace artus
