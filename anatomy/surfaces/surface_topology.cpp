// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/surfaces/surface_topology.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <tuple>
#include <unordered_map>

#include <Eigen/LU>

#include "artus/detail/anatomy/surfaces/vertex_sets.h"

namespace artus {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

/// Directed open edges: from -> to, in the direction a patch's face runs (against the face's own).
std::vector<std::pair<std::uint32_t, std::uint32_t>> open_edges(const std::vector<EdgeUse>& uses) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> open;
  for_each_edge(uses, [&](const EdgeUse* first, const EdgeUse* last) {
    if (last - first != 1) return;
    if (first->is_forward)
      open.emplace_back(first->hi, first->lo);
    else
      open.emplace_back(first->lo, first->hi);
  });
  std::sort(open.begin(), open.end());
  return open;
}

/// The solid angle of a triangle seen from `p`, signed ([VanOosterom1983]).
double solid_angle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 u = a - p;
  const Vec3 v = b - p;
  const Vec3 w = c - p;
  const double lu = u.norm();
  const double lv = v.norm();
  const double lw = w.norm();
  return 2 * std::atan2(u.dot(v.cross(w)),
                        lu * lv * lw + u.dot(v) * lw + v.dot(w) * lu + w.dot(u) * lv);
}

struct PieceBox {
  Eigen::AlignedBox3d box;
  std::vector<std::uint32_t> faces;
};

}  // namespace

std::vector<EdgeUse> make_edge_uses(const SurfaceMesh& mesh) {
  std::vector<EdgeUse> uses;
  uses.reserve(3 * mesh.triangles.size());
  for (std::uint32_t f = 0; f < mesh.triangles.size(); ++f) {
    const auto& t = mesh.triangles[f];
    for (std::size_t k = 0; k < 3; ++k) {
      const auto a = t[k];
      const auto b = t[(k + 1) % 3];
      uses.push_back({std::min(a, b), std::max(a, b), f, a < b});
    }
  }
  std::sort(uses.begin(), uses.end(), [](const EdgeUse& x, const EdgeUse& y) {
    return std::tie(x.lo, x.hi, x.face) < std::tie(y.lo, y.hi, y.face);
  });
  return uses;
}

Pieces find_pieces(const SurfaceMesh& mesh, const std::vector<EdgeUse>& uses) {
  VertexSets sets(mesh.triangles.size());
  for_each_edge(uses, [&](const EdgeUse* first, const EdgeUse* last) {
    for (const EdgeUse* u = first + 1; u < last; ++u) sets.union_set(first->face, u->face);
  });
  Pieces pieces;
  pieces.of_face.resize(mesh.triangles.size());
  std::vector<std::uint32_t> number(mesh.triangles.size(), kNone);
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
    auto& n = number[sets.find_set(f)];
    if (n == kNone) n = pieces.n++;
    pieces.of_face[f] = n;
  }
  return pieces;
}

std::vector<std::vector<std::uint32_t>> find_rims(const SurfaceMesh& mesh,
                                                  const std::vector<EdgeUse>& uses) {
  const auto open = open_edges(uses);
  std::vector<std::uint32_t> next(mesh.vertices.size(), kNone);
  for (const auto& [from, to] : open) next[from] = to;
  std::vector<std::vector<std::uint32_t>> rims;
  for (const auto& edge : open) {
    const auto start = edge.first;
    std::vector<std::uint32_t> rim;
    for (auto v = start; v != kNone && next[v] != kNone;) {
      rim.push_back(v);
      const auto n = next[v];
      next[v] = kNone;
      v = n;
    }
    if (!rim.empty()) rims.push_back(std::move(rim));
  }
  return rims;
}

EdgeCounts count_edges(const SurfaceMesh& mesh) {
  EdgeCounts counts;
  for_each_edge(make_edge_uses(mesh), [&](const EdgeUse* first, const EdgeUse* last) {
    if (last - first == 1) ++counts.open;
    if (last - first > 2) ++counts.non_manifold;
  });
  return counts;
}

bool PieceMeasure::is_pillow() const noexcept {
  // A plate a thousand times wider than thick still has 3e-4 here, so this is rounding only.
  constexpr double kNoVolume = 1e-7;
  return is_closed && (n_faces == 2 || std::abs(signed_volume) <= kNoVolume * std::pow(area, 1.5));
}

bool PieceMeasure::is_sheet() const noexcept {
  // A flat disc has rim^2 / area = 4 pi, every other flat sheet more; a half ball has 2 pi.
  constexpr double kFlatRim = 10;
  constexpr double kThin = 0.01;
  if (n_faces < 3) return !is_closed;
  return !is_closed && rim_length * rim_length >= kFlatRim * area &&
         std::abs(signed_volume) <= kThin * std::pow(area, 1.5);
}

bool PieceMeasure::is_open_beyond(double share) const noexcept {
  return opening_area > share * area;
}

std::vector<PieceMeasure> measure_pieces(const SurfaceMesh& mesh, const std::vector<EdgeUse>& uses,
                                         const Pieces& pieces) {
  std::vector<PieceMeasure> out(pieces.n);
  if (mesh.triangles.empty()) return out;
  const Vec3 o = mesh.vertices[mesh.triangles.front()[0]];
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
    const auto& t = mesh.triangles[f];
    auto& piece = out[pieces.of_face[f]];
    const Vec3 a = mesh.vertices[t[0]] - o;
    const Vec3 b = mesh.vertices[t[1]] - o;
    const Vec3 c = mesh.vertices[t[2]] - o;
    ++piece.n_faces;
    piece.area += (b - a).cross(c - a).norm() / 2;
    piece.signed_volume += a.dot(b.cross(c)) / 6;
  }
  std::unordered_map<std::uint32_t, std::uint32_t> piece_at;
  for_each_edge(uses, [&](const EdgeUse* first, const EdgeUse* last) {
    auto& piece = out[pieces.of_face[first->face]];
    if (last - first == 2 && first->is_forward == (first + 1)->is_forward)
      piece.is_consistent = false;
    if (last - first != 1) return;
    piece.is_closed = false;
    piece.rim_length += (mesh.vertices[first->lo] - mesh.vertices[first->hi]).norm();
    piece_at[first->lo] = piece_at[first->hi] = pieces.of_face[first->face];
  });
  for (const auto& rim : find_rims(mesh, uses)) {
    Vec3 centre = Vec3::Zero();
    for (const auto v : rim) centre += mesh.vertices[v] - o;
    centre /= static_cast<double>(rim.size());
    auto& piece = out[piece_at[rim[0]]];
    Vec3 span = Vec3::Zero();
    for (std::size_t k = 0; k < rim.size(); ++k) {
      const Vec3 a = mesh.vertices[rim[k]] - o;
      const Vec3 b = mesh.vertices[rim[(k + 1) % rim.size()]] - o;
      span += (a - centre).cross(b - centre) / 2;
      piece.signed_volume += a.dot(b.cross(centre)) / 6;
      piece.opening_area += (a - centre).cross(b - centre).norm() / 2;
    }
    piece.opening_span += span.norm();
  }
  return out;
}

std::vector<std::uint32_t> nesting_depth(const SurfaceMesh& mesh, const Pieces& pieces) {
  std::vector<PieceBox> boxes(pieces.n);
  for (std::uint32_t f = 0; f < mesh.triangles.size(); ++f) {
    auto& piece = boxes[pieces.of_face[f]];
    piece.faces.push_back(f);
    for (const auto v : mesh.triangles[f]) piece.box.extend(mesh.vertices[v]);
  }
  std::vector<std::uint32_t> depth(pieces.n, 0);
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const Vec3 p = mesh.vertices[mesh.triangles[boxes[i].faces.front()][0]];
    for (std::size_t j = 0; j < boxes.size(); ++j) {
      if (i == j || !boxes[j].box.contains(boxes[i].box)) continue;
      double angle = 0;
      for (const auto f : boxes[j].faces) {
        const auto& t = mesh.triangles[f];
        angle += solid_angle(p, mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]);
      }
      if (std::abs(angle) > 2 * std::numbers::pi) ++depth[i];
    }
  }
  return depth;
}

SurfaceMesh keep_faces(const SurfaceMesh& mesh, const std::vector<bool>& keep) {
  SurfaceMesh out;
  std::vector<std::uint32_t> number(mesh.vertices.size(), kNone);
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
    if (!keep[f]) continue;
    Triangle t = mesh.triangles[f];
    for (auto& v : t) {
      if (number[v] == kNone) {
        number[v] = static_cast<std::uint32_t>(out.vertices.size());
        out.vertices.push_back(mesh.vertices[v]);
      }
      v = number[v];
    }
    out.triangles.push_back(t);
  }
  return out;
}

}  // namespace artus
