// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "artus/core/result.h"
#include "artus/detail/anatomy/surfaces/surface_mesh.h"

namespace artus {

// The steps of repair_surface. Each takes a mesh, changes it, and says how much it did.

/// Drops faces that are out of range, not finite, without area, or there twice (one stays).
std::size_t drop_bad_faces(SurfaceMesh& mesh);
/// Drops closed pieces that enclose nothing.
std::size_t drop_pillows(SurfaceMesh& mesh);
/// Drops small flaps: parts that hang on an edge of more than two faces and are open elsewhere.
/// Returns how many.
std::size_t drop_flaps(SurfaceMesh& mesh);
/// Drops open shreds whose area is below a thousandth of the whole; `spare` (faces) and more stay.
std::size_t drop_fragments(SurfaceMesh& mesh);

/// Welds vertices on open edges nearer than `width`; welds that would put more than two faces on an
/// edge or take a face's area are left out. Returns the number of vertices that went.
std::size_t weld_cracks(SurfaceMesh& mesh, double width);

/// Turns faces until neighbours agree, pieces by their majority. nullopt: a piece has one side.
std::optional<std::size_t> turn_faces(SurfaceMesh& mesh);
/// Separates parts that touch in edges of more than two faces and in vertices; returns new
/// vertices.
std::size_t split_pinches(SurfaceMesh& mesh);
/// Turns whole pieces outward (cavities inward); returns how many.
std::size_t turn_pieces(SurfaceMesh& mesh);

struct Filling {
  std::size_t n = 0;
  double area = 0;            ///< m^2
  double doubtful_area = 0;   ///< m^2 of that where no cut through a solid is recognised
  std::size_t crossings = 0;  ///< pairs of faces, one of a patch, that cut through each other
};

struct CapLimits {
  double crack_width = 0;        ///< m
  double largest_share = 0;      ///< of its piece's area, the largest round end
  double largest_cut_share = 0;  ///< of its piece's area, the largest cut by a plane when it is the
                                 ///< piece's only one; 0: as for round ends
};
/// Closes flat openings: round ones with no counterpart within the crack width, and cuts by a plane
/// of any outline, also around holes. A sheet that is nearly flat has one opening, too: the limits
/// keep it open.
Filling cap_flat_ends(SurfaceMesh& mesh, const CapLimits& limits);
/// Closes all openings, each in the way that crosses fewest faces: smoothly, or (first, when it is
/// large or `flat_first`) as it is seen along its normal, or by a fan. Requires: no pinches.
Filling fill_holes(SurfaceMesh& mesh, bool flat_first = false);
/// Makes plates of `thickness` out of open sheets, and of bent ones, whose openings are larger than
/// `open_share` of their area; returns how many. Requires: oriented.
std::size_t thicken_sheets(SurfaceMesh& mesh, double thickness, double open_share);

/// Removes self-intersections locally (CGAL); false, and the mesh as it was, when some stay, a
/// hole is left, or the volume changes by more than one part in a hundred.
bool untangle(SurfaceMesh& mesh);

/// Cuts out the faces that cross others, with growing rings of neighbours, and fills the openings,
/// until none is left; a round that does not help is tried again with a wider ring. False, and the
/// mesh as it was, when some stay, a hole is left, or the volume changes by more than one part in a
/// hundred. For the folded lips of cracks that untangle cannot part.
bool cut_out_tangles(SurfaceMesh& mesh);

/// Where a wrap's vertices stand in the end.
enum class WrapPlace { on_surface, outside };

/// The shrink-wrap of a surface, laid onto it; `detail` is the size of the openings it does not
/// enter, m. The wrap is made `offset` outside the surface (m) and its vertices are then moved to
/// the nearest point of it, each as far as no face folds or crosses another: left outside, a wrap
/// makes a slender bone some percent thicker, and laid onto plates it has no thickness. Closed,
/// manifold, outward. Errors: failed.
/// Cost: some seconds, most of them for the self-intersections of the result.
[[nodiscard]] Result<SurfaceMesh> make_wrap(const SurfaceMesh& mesh, double detail, double offset,
                                            WrapPlace place = WrapPlace::on_surface);

}  // namespace artus
