// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "artus/detail/anatomy/compile/labels/construct.h"

namespace artus {

/// A piece of a gap that is not in the joint.
struct GapCut {
  std::string by;  ///< the structure that has the place; empty: a part apart from the largest
  FieldPart part;
};

struct GapField {
  DistanceField field;
  std::vector<GapCut> cuts;  ///< by structures in the order of their names, then parts by size
};

/// The field of a cleft between roof and floor, both groups of signed distances, m:
/// - half way between them, `thickness` wide: |d_roof - d_floor| < thickness, also where roof and
///   floor overlap;
/// - with roof and floor on opposite sides: what lies beyond the edge of either, or on the outer
///   side of a thin one, is no place between them. A point stands beyond an edge as far as it
///   stands away from the straight line between its nearest points of roof and floor;
/// - ended by a rim where that path exceeds `edge` / 2, where d_roof + d_floor comes to `within`
/// and
///   where the ball ends: over the length `edge` (0: the thickness) it thins out as an ellipse
///   does;
/// - never in `others`, which keep their place; and in one part, the largest.
/// Requires: `fields` holds all structures the gap names.
[[nodiscard]] GapField make_gap_field(const GapConstruct& gap, const NamedFields& fields,
                                      const NamedFields& others, const FieldSampling& sampling);

}  // namespace artus
