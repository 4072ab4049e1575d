// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/compile/mesh/tet_topology.h"

#include <algorithm>
#include <atomic>
#include <map>
#include <numeric>
#include <tuple>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

namespace artus {
namespace {

// A face of a tetrahedron, kept under the least of its vertices.
struct FaceOwner {
  std::uint32_t middle, last;  // its other vertices, ascending
  std::uint32_t tet;
  std::uint32_t face;
};

bool is_same(const FaceOwner& a, const FaceOwner& b) {
  return a.middle == b.middle && a.last == b.last;
}

// All faces, those with the same least vertex together: rows of (n_vertices + 1) firsts.
struct FaceRows {
  std::vector<std::uint32_t> first;
  std::vector<FaceOwner> faces;

  explicit FaceRows(const TetMesh& mesh)
      : first(mesh.vertices.size() + 1, 0), faces(4 * mesh.tetrahedra.size()) {
    const auto for_each_face = [&](const auto& visit) {
      for (std::uint32_t t = 0; t < mesh.tetrahedra.size(); ++t) {
        for (std::uint32_t k = 0; k < 4; ++k) {
          auto key = tet_face(mesh.tetrahedra[t], static_cast<int>(k));
          std::sort(key.begin(), key.end());
          visit(key, t, k);
        }
      }
    };
    for_each_face([&](const auto& key, std::uint32_t, std::uint32_t) { ++first[key[0] + 1]; });
    std::partial_sum(first.begin(), first.end(), first.begin());
    std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
    for_each_face([&](const auto& key, std::uint32_t t, std::uint32_t k) {
      faces[next[key[0]]++] = {key[1], key[2], t, k};
    });
  }
};

// Joins the faces of a row that are one; false when more than two are.
bool join(FaceOwner* begin, FaceOwner* end, TetNeighbours& neighbours) {
  std::sort(begin, end, [](const FaceOwner& a, const FaceOwner& b) {
    return std::tie(a.middle, a.last, a.tet) < std::tie(b.middle, b.last, b.tet);
  });
  for (FaceOwner* a = begin; a != end && a + 1 != end; ++a) {
    FaceOwner* b = a + 1;
    if (!is_same(*a, *b)) continue;
    if (b + 1 != end && is_same(*b, b[1])) return false;
    neighbours[a->tet][a->face] = b->tet;
    neighbours[b->tet][b->face] = a->tet;
  }
  return true;
}

double face_area(const TetMesh& mesh, const std::array<std::uint32_t, 3>& f) {
  const Vec3& a = mesh.vertices[f[0]];
  return (mesh.vertices[f[1]] - a).cross(mesh.vertices[f[2]] - a).norm() / 2;
}

}  // namespace

std::array<std::uint32_t, 3> tet_face(const std::array<std::uint32_t, 4>& tet, int k) noexcept {
  constexpr std::array<std::array<std::size_t, 3>, 4> kFaces{
      {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};
  const auto& f = kFaces[static_cast<std::size_t>(k)];
  return {tet[f[0]], tet[f[1]], tet[f[2]]};
}

Result<TetNeighbours> find_tet_neighbours(const TetMesh& mesh) {
  FaceRows rows(mesh);
  TetNeighbours neighbours(mesh.tetrahedra.size(), {kNoTet, kNoTet, kNoTet, kNoTet});
  std::atomic<bool> is_sound = true;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, mesh.vertices.size()),
                    [&](const auto& range) {
                      for (std::size_t v = range.begin(); v < range.end(); ++v)
                        if (!join(rows.faces.data() + rows.first[v],
                                  rows.faces.data() + rows.first[v + 1], neighbours))
                          is_sound = false;
                    });
  if (!is_sound) return fail(ErrorCode::failed, "a face is shared by more than two tetrahedra");
  return neighbours;
}

TetParts find_tet_parts(const TetMesh& mesh, const TetNeighbours& neighbours) {
  TetParts parts;
  parts.part.assign(mesh.tetrahedra.size(), kNoTet);
  std::vector<std::uint32_t> stack;
  for (std::uint32_t start = 0; start < mesh.tetrahedra.size(); ++start) {
    if (parts.part[start] != kNoTet) continue;
    const auto id = static_cast<std::uint32_t>(parts.volume.size());
    parts.region.push_back(mesh.regions[start]);
    parts.part[start] = id;
    stack.push_back(start);
    double volume = 0;
    while (!stack.empty()) {
      const std::uint32_t t = stack.back();
      stack.pop_back();
      volume += tet_volume(mesh, t);
      for (const std::uint32_t n : neighbours[t]) {
        if (n == kNoTet || parts.part[n] != kNoTet || mesh.regions[n] != mesh.regions[t]) continue;
        parts.part[n] = id;
        stack.push_back(n);
      }
    }
    parts.volume.push_back(volume);
  }
  return parts;
}

std::size_t merge_fragments(TetMesh& mesh, const TetNeighbours& neighbours,
                            const std::function<double(RegionId)>& smallest) {
  const TetParts parts = find_tet_parts(mesh, neighbours);
  std::map<RegionId, double> largest;
  for (std::size_t i = 0; i < parts.volume.size(); ++i) {
    double& v = largest[parts.region[i]];
    v = std::max(v, parts.volume[i]);
  }
  std::vector<bool> fragment(parts.volume.size());
  for (std::size_t i = 0; i < fragment.size(); ++i) {
    fragment[i] =
        parts.volume[i] < smallest(parts.region[i]) && parts.volume[i] < largest[parts.region[i]];
  }
  std::vector<std::map<RegionId, double>> shared(parts.volume.size());
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    if (!fragment[parts.part[t]]) continue;
    for (int k = 0; k < 4; ++k) {
      const std::uint32_t n = neighbours[t][static_cast<std::size_t>(k)];
      if (n == kNoTet || fragment[parts.part[n]]) continue;
      shared[parts.part[t]][mesh.regions[n]] += face_area(mesh, tet_face(mesh.tetrahedra[t], k));
    }
  }
  std::vector<RegionId> becomes(parts.region);
  std::size_t changed = 0;
  for (std::size_t i = 0; i < fragment.size(); ++i) {
    if (shared[i].empty()) continue;
    becomes[i] = std::max_element(shared[i].begin(), shared[i].end(), [](auto& a, auto& b) {
                   return a.second < b.second;
                 })->first;
    ++changed;
  }
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) mesh.regions[t] = becomes[parts.part[t]];
  return changed;
}

void rebuild_interfaces(TetMesh& mesh, const TetNeighbours& neighbours,
                        const std::function<RegionId(const Vec3&)>& front_of_hull) {
  mesh.interfaces.clear();
  for (std::uint32_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    for (int k = 0; k < 4; ++k) {
      const std::uint32_t n = neighbours[t][static_cast<std::size_t>(k)];
      const bool hull = n == kNoTet;
      if (!hull && (n < t || mesh.regions[n] == mesh.regions[t])) continue;
      const auto f = tet_face(mesh.tetrahedra[t], k);
      const Vec3 centroid = (mesh.vertices[f[0]] + mesh.vertices[f[1]] + mesh.vertices[f[2]]) / 3;
      mesh.interfaces.push_back(
          {f, hull ? front_of_hull(centroid) : mesh.regions[n], mesh.regions[t]});
    }
  }
}

void order_vertices(TetMesh& mesh) {
  std::vector<std::uint32_t> rank(mesh.vertices.size(), 2);
  for (const auto& t : mesh.tetrahedra) {
    for (const std::uint32_t v : t) rank[v] = 1;
  }
  for (const Interface& f : mesh.interfaces) {
    for (const std::uint32_t v : f.vertices) rank[v] = 0;
  }
  std::vector<std::uint32_t> renumbered(mesh.vertices.size());
  std::vector<Vec3> ordered;
  ordered.reserve(mesh.vertices.size());
  for (std::uint32_t pass = 0; pass < 2; ++pass) {
    for (std::size_t v = 0; v < rank.size(); ++v) {
      if (rank[v] != pass) continue;
      renumbered[v] = static_cast<std::uint32_t>(ordered.size());
      ordered.push_back(mesh.vertices[v]);
    }
  }
  mesh.vertices = std::move(ordered);
  for (auto& t : mesh.tetrahedra) {
    for (std::uint32_t& v : t) v = renumbered[v];
  }
  for (Interface& f : mesh.interfaces) {
    for (std::uint32_t& v : f.vertices) v = renumbered[v];
  }
}

std::vector<double> region_volumes(const TetMesh& mesh, std::size_t n_regions) {
  std::vector<double> volumes(n_regions, 0.0);
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    volumes[mesh.regions[t]] += tet_volume(mesh, t);
  }
  return volumes;
}

}  // namespace artus
