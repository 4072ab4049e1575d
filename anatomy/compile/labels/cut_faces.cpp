// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/compile/labels/cut_faces.h"

#include <algorithm>

#include <tbb/parallel_for.h>

#include "artus/detail/anatomy/surfaces/distance_tree.h"
#include "artus/detail/anatomy/surfaces/surface_topology.h"
#include "artus/detail/core/units.h"

namespace artus {
namespace {

constexpr double kAway = 2 * kMillimetre;  // from the surface as read
constexpr double kMinArea = 1e-4;          // m^2
constexpr double kFlat = 0.985;            // cosine of 10 degrees
constexpr double kMostlyFlat = 0.8;        // of a cut's area

Vec3 area_vector(const SurfaceMesh& mesh, const Triangle& t) {
  const Vec3& a = mesh.vertices[t[0]];
  return (mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a) / 2;
}

/// Without faces that are none, which no tree takes.
SurfaceMesh sound_part(const SurfaceMesh& mesh) {
  SurfaceMesh sound;
  sound.vertices = mesh.vertices;
  for (const Triangle& t : mesh.triangles)
    if (std::all_of(t.begin(), t.end(), [&](std::uint32_t v) {
          return v < mesh.vertices.size() && mesh.vertices[v].allFinite();
        }))
      sound.triangles.push_back(t);
  return sound;
}

/// The area of one piece's faces and what of it looks where the piece does as a whole.
struct Flatness {
  Vec3 sum = Vec3::Zero();
  double area = 0;
  double flat = 0;
};

}  // namespace

SurfaceMesh without_cuts(const SurfaceMesh& mesh, const std::vector<std::uint8_t>& is_cut,
                         bool cut) {
  SurfaceMesh rest;
  rest.vertices = mesh.vertices;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    if ((!is_cut.empty() && is_cut[i] != 0) == cut) rest.triangles.push_back(mesh.triangles[i]);
  return rest;
}

std::vector<std::uint8_t> find_given_cuts(const SurfaceMesh& body, const SurfaceMesh& cuts) {
  constexpr double kOn = 1e-5;  // m
  const DistanceTree tree(sound_part(cuts));
  std::vector<std::uint8_t> is_cut(body.triangles.size(), 0);
  tbb::parallel_for(std::size_t{0}, is_cut.size(), [&](std::size_t i) {
    is_cut[i] = tree.distance(triangle_centre(body, body.triangles[i]), 2 * kOn) < kOn ? 1 : 0;
  });
  return is_cut;
}

std::vector<std::uint8_t> find_cut_faces(const SurfaceMesh& read, const SurfaceMesh& repaired) {
  const DistanceTree tree(sound_part(read));
  std::vector<std::uint8_t> is_away(repaired.triangles.size(), 0);
  tbb::parallel_for(std::size_t{0}, is_away.size(), [&](std::size_t i) {
    const Vec3 centre = triangle_centre(repaired, repaired.triangles[i]);
    is_away[i] = tree.distance(centre, kAway) < kAway ? 0 : 1;
  });
  const SurfaceMesh away = without_cuts(repaired, is_away, true);
  const Pieces pieces = find_pieces(away, make_edge_uses(away));
  std::vector<Flatness> flatness(pieces.n);
  for (std::size_t i = 0; i < away.triangles.size(); ++i)
    flatness[pieces.of_face[i]].sum += area_vector(away, away.triangles[i]);
  for (std::size_t i = 0; i < away.triangles.size(); ++i) {
    Flatness& piece = flatness[pieces.of_face[i]];
    const Vec3 vector = area_vector(away, away.triangles[i]);
    piece.area += vector.norm();
    if (vector.dot(piece.sum) > kFlat * vector.norm() * piece.sum.norm())
      piece.flat += vector.norm();
  }
  std::vector<std::uint8_t> is_cut(repaired.triangles.size(), 0);
  bool any = false;
  for (std::size_t i = 0, k = 0; i < is_cut.size(); ++i) {
    if (is_away[i] == 0) continue;
    const Flatness& piece = flatness[pieces.of_face[k++]];
    if (piece.area < kMinArea || piece.flat < kMostlyFlat * piece.area) continue;
    is_cut[i] = 1;
    any = true;
  }
  return any ? is_cut : std::vector<std::uint8_t>{};
}

SurfaceMesh part_near(const Box& box, SurfaceMesh mesh) {
  const auto is_far = [&](const Triangle& t) {
    const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    return (a.cwiseMin(b).cwiseMin(c).array() > box.upper.array()).any() ||
           (a.cwiseMax(b).cwiseMax(c).array() < box.lower.array()).any();
  };
  mesh.triangles.erase(std::remove_if(mesh.triangles.begin(), mesh.triangles.end(), is_far),
                       mesh.triangles.end());
  return mesh;
}

}  // namespace artus
