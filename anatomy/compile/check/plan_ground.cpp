// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/compile/check/plan_ground.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>

#include "artus/detail/anatomy/compile/labels/cut_faces.h"
#include "artus/detail/anatomy/compile/labels/region_labels.h"
#include "artus/detail/core/units.h"

namespace artus {
namespace {

constexpr double kFar = 10;  // m, farther than anything of a body

using Kernel = CGAL::Simple_cartesian<double>;
using Triangles = std::vector<Kernel::Triangle_3>;

/// The skin's triangles, indexed for the nearest point.
class NearestPoint {
 public:
  explicit NearestPoint(const SurfaceMesh& mesh) {
    const auto corner = [&](std::uint32_t v) {
      const Vec3& p = mesh.vertices[v];
      return Kernel::Point_3(p.x(), p.y(), p.z());
    };
    for (const Triangle& t : mesh.triangles)
      triangles_.emplace_back(corner(t[0]), corner(t[1]), corner(t[2]));
    tree_.rebuild(triangles_.begin(), triangles_.end());
  }
  NearestPoint(const NearestPoint&) = delete;
  NearestPoint& operator=(const NearestPoint&) = delete;
  NearestPoint(NearestPoint&&) = delete;
  NearestPoint& operator=(NearestPoint&&) = delete;
  ~NearestPoint() = default;

  std::optional<Vec3> operator()(const Vec3& p) const {
    if (triangles_.empty()) return std::nullopt;
    const auto q = tree_.closest_point(Kernel::Point_3(p.x(), p.y(), p.z()));
    return Vec3(q.x(), q.y(), q.z());
  }

 private:
  Triangles triangles_;
  CGAL::AABB_tree<
      CGAL::AABB_traits<Kernel, CGAL::AABB_triangle_primitive<Kernel, Triangles::const_iterator>>>
      tree_;
};

/// Where the line through `p` along the unit `direction` passes through the triangle, m from `p`.
std::optional<double> intersect_line(const std::array<Vec3, 3>& t, const Vec3& p,
                                     const Vec3& direction) {
  const Vec3 u = t[1] - t[0];
  const Vec3 v = t[2] - t[0];
  const Vec3 h = direction.cross(v);
  const double det = u.dot(h);
  if (std::abs(det) < 1e-18) return std::nullopt;
  const Vec3 s = p - t[0];
  const double a = s.dot(h) / det;
  const Vec3 q = s.cross(u);
  const double b = direction.dot(q) / det;
  if (a < 0 || b < 0 || a + b > 1) return std::nullopt;
  return v.dot(q) / det;
}

bool is_inside(const DistanceTree& tree, const Vec3& p) {
  return (p.array() >= tree.lower().array()).all() && (p.array() <= tree.upper().array()).all() &&
         tree.winding_number(p) > 0.5;
}

/// What the layer at a point is called, from the surfaces alone.
class SurfaceLayers {
 public:
  SurfaceLayers(const JointFile& file, const PreparedSurfaces& surfaces, TreeWhenAsked skin)
      : file_(&file), surfaces_(&surfaces), skin_(std::move(skin)) {}

  std::vector<LineLayer> along(const Segment& line) const {
    constexpr double kStep = 0.2 * kMillimetre;
    const double length = (line.end - line.start).norm();
    const int n = std::max(1, static_cast<int>(std::ceil(length / kStep)));
    std::vector<LineLayer> layers;
    for (int i = 0; i < n; ++i) {
      const double from = length * i / n;
      const double to = length * (i + 1) / n;
      LineLayer here = at(line.start + (from + to) / 2 / length * (line.end - line.start));
      if (layers.empty() || layers.back().name != here.name) {
        here.entry = from;
        layers.push_back(std::move(here));
      }
      layers.back().exit = to;
    }
    return layers;
  }

 private:
  [[nodiscard]] LineLayer named(const std::string& name, const std::string& tissue) const {
    const auto found = std::find_if(file_->tissues.begin(), file_->tissues.end(),
                                    [&](const Tissue& t) { return t.name == tissue; });
    return {name, tissue, found != file_->tissues.end() && found->haptic.hard, 0, 0};
  }
  [[nodiscard]] LineLayer at(const Vec3& p) const {
    const auto& roi = file_->region_of_interest;
    if (!is_inside(surfaces_->body.tree, p)) return {"outside", "", false, 0, 0};
    if (roi && signed_distance(*roi, p) > 0) return {"beyond", "", false, 0, 0};
    for (std::size_t i = 0; i < file_->structures.size(); ++i) {
      const Structure& s = file_->structures[i];
      const auto* shell = std::get_if<ShellConstruct>(&s.shape);
      const bool holds = surfaces_->structures[i]
                             ? is_inside(surfaces_->structures[i]->tree, p)
                             : shell != nullptr && shell->inside.empty() &&
                                   skin_.get().distance(p, shell->thickness) < shell->thickness;
      if (holds) return named(s.name, s.tissue);
    }
    return named(file_->filler_name, file_->body.tissue);
  }

  const JointFile* file_;
  const PreparedSurfaces* surfaces_;
  TreeWhenAsked skin_;  // without what a cut closes
};

/// The layers of a line from its crossings with all interfaces.
std::vector<LineLayer> body_layers(const CompiledJoint& joint, const Segment& line) {
  struct Cut {
    double depth;
    RegionId before, after;
  };
  std::vector<Cut> cuts;
  const double length = (line.end - line.start).norm();
  const Vec3 direction = (line.end - line.start) / length;
  for (const Interface& f : joint.mesh.interfaces) {
    const auto& v = joint.mesh.vertices;
    const std::array<Vec3, 3> t{v[f.vertices[0]], v[f.vertices[1]], v[f.vertices[2]]};
    const auto depth = intersect_line(t, line.start, direction);
    if (!depth || *depth < 0 || *depth > length) continue;
    const bool from_front = (t[1] - t[0]).cross(t[2] - t[0]).dot(direction) < 0;
    cuts.push_back({*depth, from_front ? f.front : f.back, from_front ? f.back : f.front});
  }
  std::sort(cuts.begin(), cuts.end(), [](const Cut& a, const Cut& b) { return a.depth < b.depth; });
  std::vector<LineLayer> layers;
  const auto add = [&](RegionId region, double from, double to) {
    const Tissue& tissue = joint.tissue_of(region);
    layers.push_back({joint.regions[region].name, tissue.name,
                      region >= kFirstRegion && tissue.haptic.hard, from, to});
  };
  double from = 0;
  for (const Cut& cut : cuts) {
    if (cut.depth > from) add(cut.before, from, cut.depth);
    from = cut.depth;
  }
  if (cuts.empty()) return layers;
  add(cuts.back().after, from, length);
  return layers;
}

std::function<std::optional<Vec3>(const Vec3&)> nearest_of(const SurfaceMesh& skin) {
  return [tree = std::make_shared<const NearestPoint>(skin)](const Vec3& p) {
    return (*tree)(p);
  };
}

SurfaceMesh skin_in_region(const SurfaceMesh& body, const std::optional<RegionOfInterest>& roi) {
  if (!roi) return body;
  SurfaceMesh skin;
  skin.vertices = body.vertices;
  for (const Triangle& t : body.triangles)
    if (signed_distance(*roi, triangle_centre(body, t)) <= 0) skin.triangles.push_back(t);
  return skin;
}

}  // namespace

double PlanGround::skin_distance(const Vec3& p) const {
  const double distance = skin_tree.get().distance(p, kFar);
  return is_inside(hull, p) ? -distance : distance;
}

std::optional<double> PlanGround::skin_along(const Vec3& p, const Vec3& direction,
                                             double reach) const {
  std::optional<double> best;
  for (const Triangle& t : skin.triangles) {
    const auto depth = intersect_line(
        {skin.vertices[t[0]], skin.vertices[t[1]], skin.vertices[t[2]]}, p, direction);
    if (depth && std::abs(*depth) <= reach && (!best || std::abs(*depth) < std::abs(*best)))
      best = depth;
  }
  return best;
}

const HardPart* PlanGround::bone_between(const Vec3& from, const Vec3& to) const {
  constexpr double kStep = 0.5 * kMillimetre;
  const int n = std::max(1, static_cast<int>(std::ceil((to - from).norm() / kStep)));
  for (int i = 0; i <= n; ++i) {
    const Vec3 p = from + static_cast<double>(i) / n * (to - from);
    for (const HardPart& bone : bones)
      if (is_inside(bone.tree, p)) return is_inside(bone.tree, to) ? nullptr : &bone;
  }
  return nullptr;
}

bool PlanGround::in_region(const Vec3& p) const {
  return !region || signed_distance(*region, p) <= 0;
}

PlanGround make_ground(const JointFile& file, const PreparedSurfaces& surfaces) {
  PlanGround ground;
  ground.region = file.region_of_interest;
  const PreparedSurface& body = surfaces.body;
  ground.skin = skin_in_region(without_cuts(body.mesh, body.is_cut), ground.region);
  ground.hull = body.tree;
  if (body.is_cut.empty()) {
    ground.skin_tree = TreeWhenAsked(body.tree);
  } else {
    ground.skin_tree = TreeWhenAsked([&body] { return without_cuts(body.mesh, body.is_cut); });
    ground.cut_tree = TreeWhenAsked([&body] { return without_cuts(body.mesh, body.is_cut, true); });
  }
  ground.nearest_skin = nearest_of(ground.skin);
  ground.nearest_any_skin = [&body](const Vec3& p) {
    return nearest_of(without_cuts(body.mesh, body.is_cut))(p);
  };
  for (std::size_t i = 0; i < file.structures.size(); ++i) {
    const auto tissue =
        std::find_if(file.tissues.begin(), file.tissues.end(),
                     [&](const Tissue& t) { return t.name == file.structures[i].tissue; });
    if (surfaces.structures[i] && tissue != file.tissues.end() && tissue->haptic.hard)
      ground.bones.push_back({file.structures[i].name, surfaces.structures[i]->tree});
  }
  ground.layers = [layers = SurfaceLayers(file, surfaces, ground.skin_tree)](const Segment& line) {
    return layers.along(line);
  };
  return ground;
}

PlanGround make_ground(const CompiledJoint& joint, const std::optional<RegionOfInterest>& region) {
  PlanGround ground;
  ground.region = region;
  ground.is_compiled = true;
  ground.skin.vertices = joint.mesh.vertices;
  SurfaceMesh hull;
  hull.vertices = joint.mesh.vertices;
  std::vector<SurfaceMesh> parts(joint.regions.size());
  const auto is_hard = [&](RegionId r) {
    return r >= kFirstRegion && joint.tissue_of(r).haptic.hard;
  };
  // An interface's corners are counter-clockwise seen from its front.
  const auto add = [](SurfaceMesh& mesh, const Interface& f, bool seen_from_front) {
    Triangle t{f.vertices[0], f.vertices[1], f.vertices[2]};
    if (!seen_from_front) std::swap(t[1], t[2]);
    mesh.triangles.push_back(t);
  };
  for (const Interface& f : joint.mesh.interfaces) {
    if (f.front < kFirstRegion || f.back < kFirstRegion) add(hull, f, f.front < kFirstRegion);
    if (f.front == kOutside || f.back == kOutside) add(ground.skin, f, f.front == kOutside);
    if (is_hard(f.front)) add(parts[f.front], f, false);
    if (is_hard(f.back)) add(parts[f.back], f, true);
  }
  ground.hull = DistanceTree(hull);
  ground.nearest_skin = nearest_of(ground.skin);
  ground.nearest_any_skin = ground.nearest_skin;
  ground.skin_tree = TreeWhenAsked(DistanceTree(ground.skin));
  for (std::size_t r = 0; r < parts.size(); ++r) {
    if (parts[r].triangles.empty()) continue;
    parts[r].vertices = joint.mesh.vertices;
    ground.bones.push_back({joint.regions[r].name, DistanceTree(parts[r])});
  }
  ground.layers = [&joint](const Segment& line) {
    return body_layers(joint, line);
  };
  return ground;
}

}  // namespace artus
