// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstdint>
#include <vector>

#include "artus/detail/anatomy/surfaces/surface_mesh.h"

namespace artus {

/// One side of a triangle; `is_forward` when the face runs from lo to hi.
struct EdgeUse {
  std::uint32_t lo = 0;
  std::uint32_t hi = 0;
  std::uint32_t face = 0;
  bool is_forward = true;
};

/// All sides of all triangles, sorted by (lo, hi, face): the uses of one edge stand together.
[[nodiscard]] std::vector<EdgeUse> make_edge_uses(const SurfaceMesh& mesh);

/// Calls `visit(first, last)` for the uses of each edge.
template <class Visit>
void for_each_edge(const std::vector<EdgeUse>& uses, Visit visit) {
  for (std::size_t i = 0; i < uses.size();) {
    std::size_t j = i + 1;
    while (j < uses.size() && uses[j].lo == uses[i].lo && uses[j].hi == uses[i].hi) ++j;
    visit(uses.data() + i, uses.data() + j);
    i = j;
  }
}

/// Which connected piece each face belongs to; pieces are numbered in order of their first face.
struct Pieces {
  std::vector<std::uint32_t> of_face;  ///< (n_triangles)
  std::uint32_t n = 0;
};

/// Pieces connected through shared edges.
[[nodiscard]] Pieces find_pieces(const SurfaceMesh& mesh, const std::vector<EdgeUse>& uses);

/// The rims of an oriented surface, each a closed run of vertices in the direction that a patch's
/// face must have. Requires: no vertex on two rims (split_pinches) for the runs to be simple.
[[nodiscard]] std::vector<std::vector<std::uint32_t>> find_rims(const SurfaceMesh& mesh,
                                                                const std::vector<EdgeUse>& uses);

/// Number of edges used by exactly one face, and by more than two.
struct EdgeCounts {
  std::size_t open = 0;
  std::size_t non_manifold = 0;
};
[[nodiscard]] EdgeCounts count_edges(const SurfaceMesh& mesh);

/// Size measures of one piece.
struct PieceMeasure {
  std::size_t n_faces = 0;
  double area = 0;           ///< m^2
  double signed_volume = 0;  ///< m^3, openings closed by a fan to their centre
  double rim_length = 0;     ///< m
  double opening_area = 0;   ///< m^2, of those fans
  double opening_span = 0;  ///< m^2, of the openings as seen along their normals: teeth add nothing
  bool is_closed = true;    ///< no open edge
  bool is_consistent = true;

  /// Closed, but encloses nothing: faces that lie back to back.
  [[nodiscard]] bool is_pillow() const noexcept;
  /// Open and without an inside: a membrane drawn as one layer of triangles.
  [[nodiscard]] bool is_sheet() const noexcept;
  /// Its openings are larger than `share` of its own area: a bowl, or a sheet that is bent.
  [[nodiscard]] bool is_open_beyond(double share) const noexcept;
};
[[nodiscard]] std::vector<PieceMeasure> measure_pieces(const SurfaceMesh& mesh,
                                                       const std::vector<EdgeUse>& uses,
                                                       const Pieces& pieces);

/// How many of the other closed pieces each piece lies in. Cost: pieces squared times their faces,
/// boxes first.
[[nodiscard]] std::vector<std::uint32_t> nesting_depth(const SurfaceMesh& mesh,
                                                       const Pieces& pieces);

/// The faces for which `keep` holds, without the vertices nobody uses.
[[nodiscard]] SurfaceMesh keep_faces(const SurfaceMesh& mesh, const std::vector<bool>& keep);

}  // namespace artus
