// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "artus/detail/anatomy/surfaces/surface_mesh.h"

namespace artus {

/// What can be wrong with a surface, and (from unknown_tissue on) with a joint made of surfaces.
enum class DefectKind {
  empty,                     ///< no triangle
  index_out_of_range,        ///< a face names a vertex that is not there
  non_finite_coordinate,     ///< a vertex is NaN or infinite
  degenerate_face,           ///< a triangle without area
  duplicate_face,            ///< the same three vertices twice
  unwelded_vertex,           ///< vertices of a crack that belong together
  open_edge,                 ///< an edge with one face: a hole, a tube end, a cut
  non_manifold_edge,         ///< an edge with more than two faces
  non_manifold_vertex,       ///< two fans of faces that touch in a point
  inconsistent_orientation,  ///< neighbouring faces that run against each other
  inward_winding,            ///< a closed piece whose faces look inward
  self_intersection,         ///< faces that cut through each other
  several_components,        ///< more than one connected piece
  pillow_component,          ///< a closed piece that encloses nothing
  zero_thickness_sheet,      ///< an open piece without an inside
  implausible_size,          ///< no part of a body is so large, small or far: a wrong unit
  unreadable_file,           ///< the surface file cannot be read; the message says why
  unknown_tissue,            ///< a structure of a tissue that the library does not have
  crossing_layers,           ///< two structures that cut through each other
  size_outlier,              ///< far smaller or larger than its like: a wrong unit of one file
  place_outlier              ///< far from everything else of the joint
};
inline constexpr DefectKind kLastSurfaceDefect = DefectKind::implausible_size;
inline constexpr DefectKind kLastDefect = DefectKind::place_outlier;

/// The stable name of a kind, as JSON output and tests/data/bad/ have it ("open_edge").
[[nodiscard]] const char* to_string(DefectKind kind) noexcept;

/// What becomes of a defect: nothing needs to (note), repair_surface mends it, somebody should look
/// though it can be compiled or repair may yet mend it (doubtful), or nobody can (fatal).
enum class DefectSeverity { note, repairable, doubtful, fatal };
[[nodiscard]] DefectSeverity severity_of(DefectKind kind) noexcept;
[[nodiscard]] const char* to_string(DefectSeverity severity) noexcept;

/// All occurrences of one kind of defect in one surface (or pair of surfaces).
struct Defect {
  DefectKind kind{};
  std::string structure;              ///< of a joint; empty for a surface by itself
  std::size_t count = 0;              ///< occurrences
  std::vector<std::size_t> elements;  ///< faces (or vertices, where the kind says vertex)
  Vec3 position = Vec3::Zero();       ///< of the first occurrence, m
  std::string message;                ///< what, how many, where, what to do
};

struct DefectOptions {
  bool self_intersections = true;  ///< the only costly check
  double crack_width = 0.5e-3;     ///< m, open vertices nearer than this belong together
  double smallest = 1e-3;          ///< m, of the box's diagonal
  double largest = 2.5;            ///< m
  double farthest = 10;            ///< m, of a coordinate
};

/// Lists every kind of defect of `mesh`, at most one entry per kind, in the order of DefectKind.
/// Empty means: closed, manifold, oriented outward, free of self-intersections, of a body's size.
/// Errors: none; any mesh may be asked about. Cost: n log n; 44 k triangles take about 0.2 s.
[[nodiscard]] std::vector<Defect> find_defects(const SurfaceMesh& mesh,
                                               const DefectOptions& options = {});

/// Pairs of faces that cut through each other, with exact predicates; faces that share an edge
/// only when they are folded onto each other. Degenerate and non-finite faces are left out.
/// Stops at `limit` pairs.
[[nodiscard]] std::vector<std::pair<std::size_t, std::size_t>> find_self_intersections(
    const SurfaceMesh& mesh, std::size_t limit = 1'000'000);

/// A surface with the name of its structure, for questions about a joint as a whole.
struct NamedSurface {
  std::string name;
  std::string tissue;
  SurfaceMesh mesh;
  bool has_own_unit = false;  ///< its size is not doubted
  std::string partition;      ///< two of one are not asked whether they cross; empty: of none
};

/// Structures out of scale or place with respect to the others; `surfaces` may hold the body.
/// A size is told when it differs from the median of its tissue (all, when it has fewer than three
/// of its kind) by more than 15 times and no unit was given for this file; a place when the surface
/// lies outside the others' box by more than the box's size.
[[nodiscard]] std::vector<Defect> find_outliers(const std::vector<NamedSurface>& surfaces);

/// Pairs of structures whose surfaces cut through each other: one defect per pair, count = pairs of
/// faces. Cost: n log n in all triangles.
[[nodiscard]] std::vector<Defect> find_crossings(const std::vector<NamedSurface>& surfaces);

}  // namespace artus
