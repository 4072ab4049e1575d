// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/import/swept_tube.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "artus/detail/core/printed.h"
#include "artus/detail/core/units.h"

namespace artus {
namespace {

constexpr std::uint32_t kSides = 16;
constexpr int kCapRings = 3;  // between the last full ring and the pole
constexpr double kLeastApart = 0.1 * kMillimetre;
constexpr double kThinnest = 0.2 * kMillimetre;
constexpr double kThickest = 30 * kMillimetre;

/// Between b and c of four points of a centripetal Catmull-Rom curve, t from 0 to 1.
Vec3 on_curve(const std::array<Vec3, 4>& p, double t) {
  std::array<double, 4> knots{};
  for (std::size_t i = 1; i < 4; ++i) knots[i] = knots[i - 1] + std::sqrt((p[i] - p[i - 1]).norm());
  const double at = knots[1] + t * (knots[2] - knots[1]);
  const auto mix = [&](const Vec3& a, const Vec3& b, std::size_t i, std::size_t k) {
    const double span = knots[k] - knots[i];
    return Vec3(a * ((knots[k] - at) / span) + b * ((at - knots[i]) / span));
  };
  const Vec3 ab = mix(p[0], p[1], 0, 1);
  const Vec3 bc = mix(p[1], p[2], 1, 2);
  const Vec3 cd = mix(p[2], p[3], 2, 3);
  return mix(mix(ab, bc, 0, 2), mix(bc, cd, 1, 3), 1, 2);
}

/// Points of the curve, at most `step` apart.
std::vector<Vec3> sample_curve(std::span<const Vec3> points, double step) {
  std::vector<Vec3> samples;
  const std::size_t n = points.size();
  for (std::size_t i = 0; i + 1 < n; ++i) {
    const Vec3& b = points[i];
    const Vec3& c = points[i + 1];
    // Beyond the ends the curve goes straight on.
    const std::array<Vec3, 4> four{i > 0 ? points[i - 1] : Vec3(2 * b - c), b, c,
                                   i + 2 < n ? points[i + 2] : Vec3(2 * c - b)};
    const int parts = std::max(2, static_cast<int>(std::ceil((c - b).norm() / step)));
    for (int k = 0; k < parts; ++k)
      samples.push_back(on_curve(four, static_cast<double>(k) / parts));
  }
  samples.push_back(points.back());
  return samples;
}

Vec3 direction_at(const std::vector<Vec3>& curve, std::size_t i) {
  const Vec3& before = curve[i > 0 ? i - 1 : 0];
  const Vec3& after = curve[std::min(i + 1, curve.size() - 1)];
  return (after - before).normalized();
}

/// Rings of vertices, one after the other, and the faces between them.
class TubeMaker {
 public:
  explicit TubeMaker(double radius) : radius_(radius) {}

  SurfaceMesh run(const std::vector<Vec3>& curve) {
    Vec3 along = direction_at(curve, 0);
    across_ = along.unitOrthogonal();
    add_pole(curve.front() - radius_ * along);
    for (int k = kCapRings; k > 0; --k) add_cap_ring(curve.front(), along, k, -1);
    for (std::size_t i = 0; i < curve.size(); ++i) {
      along = direction_at(curve, i);
      across_ = (across_ - across_.dot(along) * along).normalized();  // carried along, not turned
      add_ring(curve[i], along, radius_);
    }
    for (int k = 1; k <= kCapRings; ++k) add_cap_ring(curve.back(), along, k, 1);
    close(curve.back() + radius_ * along);
    return std::move(mesh_);
  }

 private:
  void add_pole(const Vec3& p) { mesh_.vertices.push_back(p); }

  void add_cap_ring(const Vec3& centre, const Vec3& along, int k, double sign) {
    const double angle = std::numbers::pi / 2 * k / (kCapRings + 1);
    add_ring(centre + sign * radius_ * std::sin(angle) * along, along, radius_ * std::cos(angle));
  }

  void add_ring(const Vec3& centre, const Vec3& along, double radius) {
    const Vec3 up = along.cross(across_);
    const auto first = static_cast<std::uint32_t>(mesh_.vertices.size());
    for (std::uint32_t k = 0; k < kSides; ++k) {
      const double angle = 2 * std::numbers::pi * k / kSides;
      mesh_.vertices.push_back(centre +
                               radius * (std::cos(angle) * across_ + std::sin(angle) * up));
    }
    for (std::uint32_t k = 0; k < kSides; ++k) {
      const std::uint32_t next = (k + 1) % kSides;
      if (first == 1) {
        mesh_.triangles.push_back({0, first + next, first + k});
        continue;
      }
      const std::uint32_t below = first - kSides;
      mesh_.triangles.push_back({below + k, below + next, first + next});
      mesh_.triangles.push_back({below + k, first + next, first + k});
    }
  }

  void close(const Vec3& pole) {
    const auto top = static_cast<std::uint32_t>(mesh_.vertices.size());
    mesh_.vertices.push_back(pole);
    for (std::uint32_t k = 0; k < kSides; ++k)
      mesh_.triangles.push_back({top - kSides + k, top - kSides + (k + 1) % kSides, top});
  }

  double radius_;
  Vec3 across_ = Vec3::UnitX();
  SurfaceMesh mesh_;
};

/// Where the curve bends more sharply than a circle of `radius`; nullopt: nowhere.
std::optional<Vec3> find_sharp_bend(const std::vector<Vec3>& curve, double radius) {
  for (std::size_t i = 1; i + 1 < curve.size(); ++i) {
    const Vec3 before = curve[i] - curve[i - 1];
    const Vec3 after = curve[i + 1] - curve[i];
    const double angle =
        std::acos(std::clamp(before.normalized().dot(after.normalized()), -1.0, 1.0));
    if (angle * radius > (before.norm() + after.norm()) / 2) return curve[i];
  }
  return std::nullopt;
}

}  // namespace

Result<SurfaceMesh> sweep_tube(std::span<const Vec3> points, double radius,
                               const std::string& where) {
  if (points.size() < 2)
    return fail(ErrorCode::invalid, "a tube needs two points or more along its way", where);
  if (!(radius >= kThinnest && radius <= kThickest))
    return fail(ErrorCode::invalid, "the radius of a tube is from 0.2 to 30 mm", where);
  for (std::size_t i = 0; i < points.size(); ++i)
    if (!points[i].allFinite() || (i > 0 && !((points[i] - points[i - 1]).norm() >= kLeastApart)))
      return fail(ErrorCode::invalid,
                  printed("point %zu lies on the one before it or is no place", i + 1), where);
  const std::vector<Vec3> curve = sample_curve(points, radius);
  if (const auto bend = find_sharp_bend(curve, radius))
    return fail(ErrorCode::invalid,
                printed("at (%.1f, %.1f, %.1f) mm its way bends more sharply than its radius of "
                        "%.2g mm allows; set points farther apart there, or a smaller radius",
                        bend->x() / kMillimetre, bend->y() / kMillimetre, bend->z() / kMillimetre,
                        radius / kMillimetre),
                where);
  return TubeMaker(radius).run(curve);
}

Result<void> add_tubes(ImportedJoint& joint, std::span<const NamedTube> tubes) {
  std::vector<ImportedStructure> made;
  for (const NamedTube& tube : tubes) {
    ImportedStructure s;
    s.name = plain_structure_name(tube.name);
    s.source = tube.name;
    s.tissue = tube.tissue;
    s.by = printed("assumed: a tube of %.2g mm along %zu points", 2 * tube.radius / kMillimetre,
                   tube.points.size());
    s.is_swept = true;
    const auto is_same = [&](const ImportedStructure& other) {
      return other.name == s.name;
    };
    if (s.name.empty() || std::any_of(joint.structures.begin(), joint.structures.end(), is_same) ||
        std::any_of(made.begin(), made.end(), is_same))
      return fail(ErrorCode::invalid, "there is a structure of that name already; give another one",
                  "[[tube]] '" + tube.name + "'");
    auto mesh = sweep_tube(tube.points, tube.radius, "[[tube]] '" + tube.name + "'");
    ARTUS_TRY(mesh);
    s.mesh = std::move(*mesh);
    s.volumes.fitted = signed_volume(s.mesh);
    joint.assumed.push_back("'" + s.name + "': " + s.by.substr(s.by.find(':') + 2));
    made.push_back(std::move(s));
  }
  joint.structures.insert(joint.structures.begin(), std::make_move_iterator(made.begin()),
                          std::make_move_iterator(made.end()));
  return {};
}

}  // namespace artus
