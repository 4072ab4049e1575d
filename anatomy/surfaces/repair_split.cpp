// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>
#include <limits>
#include <numbers>

#include <Eigen/Geometry>

#include "artus/detail/anatomy/surfaces/repair_steps.h"
#include "artus/detail/anatomy/surfaces/surface_topology.h"
#include "artus/detail/anatomy/surfaces/vertex_sets.h"

namespace artus {
namespace {

constexpr std::uint32_t kNoVertex = std::numeric_limits<std::uint32_t>::max();

/// Two faces that are neighbours over an edge; `agree` when they run along it in opposite senses.
struct Link {
  std::uint32_t a = 0;
  std::uint32_t b = 0;
  std::uint32_t lo = 0;
  std::uint32_t hi = 0;
  bool agree = true;
};

/// The angle of a face around the edge lo-hi, 0 to 2 pi, against an arbitrary fixed direction.
double angle_around(const SurfaceMesh& mesh, const EdgeUse& use) {
  const auto& t = mesh.triangles[use.face];
  std::uint32_t apex = t[0];
  for (const auto v : t)
    if (v != use.lo && v != use.hi) apex = v;
  const Vec3 axis = (mesh.vertices[use.hi] - mesh.vertices[use.lo]).stableNormalized();
  const Vec3 x = axis.unitOrthogonal();
  const Vec3 out = mesh.vertices[apex] - mesh.vertices[use.lo];
  const double angle = std::atan2(axis.cross(x).dot(out), x.dot(out));
  return angle < 0 ? angle + 2 * std::numbers::pi : angle;
}

/// The faces of a crowded edge in pairs: neighbours around the edge, paired so that the wedges
/// between the partners are narrowest in sum (two bodies that touch). An odd one stays alone.
void pair_crowded(const SurfaceMesh& mesh, const EdgeUse* first, const EdgeUse* last,
                  std::vector<Link>& links) {
  std::vector<std::pair<double, const EdgeUse*>> around;
  for (const auto* u = first; u != last; ++u) around.emplace_back(angle_around(mesh, *u), u);
  std::sort(around.begin(), around.end(), [](const auto& x, const auto& y) {
    return std::pair(x.first, x.second->face) < std::pair(y.first, y.second->face);
  });
  const std::size_t n = around.size();
  const auto wedge = [&](std::size_t i) {
    const double d = around[(i + 1) % n].first - around[i % n].first;
    return d < 0 ? d + 2 * std::numbers::pi : d;
  };
  double best = std::numeric_limits<double>::infinity();
  std::size_t best_start = 0;
  for (std::size_t start = 0; start < (n % 2 == 0 ? 2 : n); ++start) {
    double sum = 0;
    for (std::size_t k = 0; k + 1 < n; k += 2) {
      constexpr double kOutside = 0.5;  // rad; a wedge of air counts as wider than one of body
      sum += wedge(start + k) + (around[(start + k) % n].second->is_forward ? kOutside : 0);
    }
    if (sum >= best) continue;
    best = sum;
    best_start = start;
  }
  for (std::size_t k = 0; k + 1 < n; k += 2) {
    const EdgeUse* a = around[(best_start + k) % n].second;
    const EdgeUse* b = around[(best_start + k + 1) % n].second;
    links.push_back({a->face, b->face, a->lo, a->hi, a->is_forward != b->is_forward});
  }
}

std::vector<Link> find_links(const SurfaceMesh& mesh, const std::vector<EdgeUse>& uses) {
  std::vector<Link> links;
  for_each_edge(uses, [&](const EdgeUse* first, const EdgeUse* last) {
    if (last - first == 2)
      links.push_back({first->face, (first + 1)->face, first->lo, first->hi,
                       first->is_forward != (first + 1)->is_forward});
    if (last - first > 2) pair_crowded(mesh, first, last, links);
  });
  return links;
}

/// Links per face, flat.
struct Neighbours {
  std::vector<std::size_t> start;
  std::vector<std::pair<std::uint32_t, bool>> of;  ///< (other face, agree)
};

Neighbours make_neighbours(std::size_t n_faces, const std::vector<Link>& links) {
  Neighbours out;
  out.start.assign(n_faces + 1, 0);
  for (const auto& l : links) {
    ++out.start[l.a + 1];
    ++out.start[l.b + 1];
  }
  for (std::size_t f = 0; f < n_faces; ++f) out.start[f + 1] += out.start[f];
  out.of.resize(2 * links.size());
  auto next = out.start;
  for (const auto& l : links) {
    out.of[next[l.a]++] = {l.b, l.agree};
    out.of[next[l.b]++] = {l.a, l.agree};
  }
  return out;
}

/// Walks over one piece from `seed` and decides for each face whether it has to be turned.
/// side: 0 unseen, 1 as it is, 2 turned. Returns the faces; empty when the piece has one side.
std::vector<std::uint32_t> walk_piece(const Neighbours& neighbours, std::uint32_t seed,
                                      std::vector<std::uint8_t>& side) {
  std::vector<std::uint32_t> faces{seed};
  side[seed] = 1;
  for (std::size_t i = 0; i < faces.size(); ++i) {
    const auto f = faces[i];
    for (std::size_t k = neighbours.start[f]; k < neighbours.start[f + 1]; ++k) {
      const auto [g, agree] = neighbours.of[k];
      const auto wanted = static_cast<std::uint8_t>(agree ? side[f] : 3 - side[f]);
      if (side[g] == 0) {
        side[g] = wanted;
        faces.push_back(g);
      } else if (side[g] != wanted) {
        return {};
      }
    }
  }
  return faces;
}

std::size_t corner_of(const Triangle& t, std::uint32_t v) {
  return t[0] == v ? 0 : (t[1] == v ? 1 : 2);
}

}  // namespace

std::optional<std::size_t> turn_faces(SurfaceMesh& mesh) {
  const auto neighbours =
      make_neighbours(mesh.triangles.size(), find_links(mesh, make_edge_uses(mesh)));
  std::vector<std::uint8_t> side(mesh.triangles.size(), 0);
  std::size_t turned = 0;
  for (std::uint32_t seed = 0; seed < side.size(); ++seed) {
    if (side[seed] != 0) continue;
    const auto faces = walk_piece(neighbours, seed, side);
    if (faces.empty()) return std::nullopt;
    const auto n_second = static_cast<std::size_t>(
        std::count_if(faces.begin(), faces.end(), [&](auto f) { return side[f] == 2; }));
    const std::uint8_t minority = 2 * n_second > faces.size() ? 1 : 2;
    for (const auto f : faces) {
      if (side[f] != minority) continue;
      std::swap(mesh.triangles[f][1], mesh.triangles[f][2]);
      ++turned;
    }
  }
  return turned;
}

std::size_t split_pinches(SurfaceMesh& mesh) {
  VertexSets fans(3 * mesh.triangles.size());
  for (const auto& l : find_links(mesh, make_edge_uses(mesh)))
    for (const auto v : {l.lo, l.hi})
      fans.union_set(std::size_t{3} * l.a + corner_of(mesh.triangles[l.a], v),
                     std::size_t{3} * l.b + corner_of(mesh.triangles[l.b], v));
  // The first fan met at a vertex keeps it, each other gets a copy of its own.
  std::vector<std::uint32_t> vertex_of_fan(3 * mesh.triangles.size(), kNoVertex);
  std::vector<bool> is_taken(mesh.vertices.size(), false);
  const std::size_t before = mesh.vertices.size();
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
    for (std::size_t k = 0; k < 3; ++k) {
      auto& v = mesh.triangles[f][k];
      auto& own = vertex_of_fan[fans.find_set(3 * f + k)];
      if (own == kNoVertex && !is_taken[v]) {
        own = v;
        is_taken[v] = true;
      } else if (own == kNoVertex) {
        own = static_cast<std::uint32_t>(mesh.vertices.size());
        const Vec3 copy = mesh.vertices[v];
        mesh.vertices.push_back(copy);
      }
      v = own;
    }
  }
  return mesh.vertices.size() - before;
}

std::size_t turn_pieces(SurfaceMesh& mesh) {
  const auto uses = make_edge_uses(mesh);
  const auto pieces = find_pieces(mesh, uses);
  const auto measures = measure_pieces(mesh, uses, pieces);
  const auto depth = nesting_depth(mesh, pieces);
  const auto is_wrong = [&](std::size_t piece) {
    return (measures[piece].signed_volume < 0) != (depth[piece] % 2 == 1);
  };
  std::size_t n = 0;
  for (std::size_t piece = 0; piece < pieces.n; ++piece) n += is_wrong(piece) ? 1U : 0U;
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f)
    if (is_wrong(pieces.of_face[f])) std::swap(mesh.triangles[f][1], mesh.triangles[f][2]);
  return n;
}

}  // namespace artus
