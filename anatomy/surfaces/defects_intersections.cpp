// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>
#include <limits>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/box_intersection_d.h>

#include "artus/detail/anatomy/surfaces/defects.h"
#include "artus/detail/anatomy/surfaces/surface_topology.h"

namespace artus {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using CgalTriangle = Kernel::Triangle_3;
using CgalSegment = Kernel::Segment_3;

/// A face of one of several surfaces with its box.
class FaceBox : public CGAL::Box_intersection_d::Box_d<double, 3> {
 public:
  FaceBox(const CGAL::Bbox_3& box, std::uint32_t surface, std::uint32_t face)
      : Box_d(box), surface_(surface), face_(face) {}
  [[nodiscard]] std::uint32_t surface() const { return surface_; }
  [[nodiscard]] std::uint32_t face() const { return face_; }

 private:
  std::uint32_t surface_;
  std::uint32_t face_;
};

Point to_point(const Vec3& p) {
  return {p.x(), p.y(), p.z()};
}

std::array<Point, 3> corners(const SurfaceMesh& mesh, std::size_t face) {
  const auto& t = mesh.triangles[face];
  return {to_point(mesh.vertices[t[0]]), to_point(mesh.vertices[t[1]]),
          to_point(mesh.vertices[t[2]])};
}

bool is_sound(const SurfaceMesh& mesh, const Triangle& t) {
  for (const auto v : t)
    if (v >= mesh.vertices.size() || !mesh.vertices[v].allFinite()) return false;
  return !CGAL::collinear(to_point(mesh.vertices[t[0]]), to_point(mesh.vertices[t[1]]),
                          to_point(mesh.vertices[t[2]]));
}

void append_boxes(const SurfaceMesh& mesh, std::uint32_t surface, std::vector<FaceBox>& boxes) {
  for (std::uint32_t f = 0; f < mesh.triangles.size(); ++f) {
    if (!is_sound(mesh, mesh.triangles[f])) continue;
    const auto p = corners(mesh, f);
    boxes.emplace_back(p[0].bbox() + p[1].bbox() + p[2].bbox(), surface, f);
  }
}

/// Two faces with the same edge meet elsewhere only when they are folded onto each other.
bool is_folded(const Point& a, const Point& b, const Point& c, const Point& d) {
  return CGAL::coplanar(a, b, c, d) && CGAL::coplanar_orientation(a, b, c, d) == CGAL::POSITIVE;
}

/// Two faces with one common vertex meet elsewhere when the far side of one meets the other.
bool meets_beyond_vertex(const std::array<Point, 3>& p, std::size_t i,
                         const std::array<Point, 3>& q, std::size_t j) {
  return CGAL::do_intersect(CgalTriangle(p[0], p[1], p[2]),
                            CgalSegment(q[(j + 1) % 3], q[(j + 2) % 3])) ||
         CGAL::do_intersect(CgalTriangle(q[0], q[1], q[2]),
                            CgalSegment(p[(i + 1) % 3], p[(i + 2) % 3]));
}

/// Corners are the same when their positions are: an unwelded seam is no intersection.
bool do_faces_intersect(const std::array<Point, 3>& p, const std::array<Point, 3>& q) {
  std::array<std::pair<std::size_t, std::size_t>, 3> shared{};
  std::size_t n = 0;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      if (p[i] == q[j] && n < 3) shared[n++] = {i, j};
  if (n == 0)
    return CGAL::do_intersect(CgalTriangle(p[0], p[1], p[2]), CgalTriangle(q[0], q[1], q[2]));
  if (n == 1) return meets_beyond_vertex(p, shared[0].first, q, shared[0].second);
  if (n == 2) {
    const auto far_p = 3 - shared[0].first - shared[1].first;
    const auto far_q = 3 - shared[0].second - shared[1].second;
    return is_folded(p[shared[0].first], p[shared[1].first], p[far_p], q[far_q]);
  }
  return false;  // the same face twice: a defect of its own
}

struct LimitReached {};

constexpr std::string_view kBodyName = "body";  // JointFile::body's, which no structure may have

}  // namespace

std::vector<std::pair<std::size_t, std::size_t>> find_self_intersections(const SurfaceMesh& mesh,
                                                                         std::size_t limit) {
  std::vector<FaceBox> boxes;
  append_boxes(mesh, 0, boxes);
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  try {
    CGAL::box_self_intersection_d(
        boxes.begin(), boxes.end(), [&](const FaceBox& a, const FaceBox& b) {
          if (!do_faces_intersect(corners(mesh, a.face()), corners(mesh, b.face()))) return;
          pairs.emplace_back(std::min(a.face(), b.face()), std::max(a.face(), b.face()));
          if (pairs.size() >= limit) throw LimitReached{};
        });
  } catch (const LimitReached&) {
    pairs.resize(limit);
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

std::vector<Defect> find_crossings(const std::vector<NamedSurface>& surfaces) {
  std::vector<FaceBox> boxes;
  for (std::uint32_t s = 0; s < surfaces.size(); ++s) append_boxes(surfaces[s].mesh, s, boxes);
  struct Hit {
    std::uint32_t first, second, face;
    bool operator<(const Hit& o) const {
      return std::tie(first, second, face) < std::tie(o.first, o.second, o.face);
    }
  };
  std::vector<Hit> hits;
  CGAL::box_self_intersection_d(
      boxes.begin(), boxes.end(), [&](const FaceBox& a, const FaceBox& b) {
        if (a.surface() == b.surface()) return;
        const auto& partition = surfaces[a.surface()].partition;
        if (!partition.empty() && partition == surfaces[b.surface()].partition) return;
        const auto p = corners(surfaces[a.surface()].mesh, a.face());
        const auto q = corners(surfaces[b.surface()].mesh, b.face());
        if (!CGAL::do_intersect(CgalTriangle(p[0], p[1], p[2]), CgalTriangle(q[0], q[1], q[2])))
          return;
        const auto& lower = a.surface() < b.surface() ? a : b;
        hits.push_back({lower.surface(), std::max(a.surface(), b.surface()), lower.face()});
      });
  std::sort(hits.begin(), hits.end());
  std::vector<Defect> defects;
  for (std::size_t i = 0; i < hits.size();) {
    std::size_t j = i;
    Defect defect{DefectKind::crossing_layers, surfaces[hits[i].first].name, 0, {}, {}, {}};
    for (; j < hits.size() && hits[j].first == hits[i].first && hits[j].second == hits[i].second;
         ++j)
      if (defect.elements.empty() || defect.elements.back() != hits[j].face)
        defect.elements.push_back(hits[j].face);
    defect.count = j - i;
    const auto& mesh = surfaces[hits[i].first].mesh;
    defect.position = mesh.vertices[mesh.triangles[hits[i].face][0]];
    defect.message = "cuts through '" + surfaces[hits[i].second].name + "' (" +
                     std::to_string(defect.count) + " pairs of faces); " +
                     (defect.structure == kBodyName
                          ? "what lies outside the body's surface is cut off"
                          : "the one that stands first in the joint file keeps the overlap");
    defects.push_back(std::move(defect));
    i = j;
  }
  return defects;
}

}  // namespace artus
