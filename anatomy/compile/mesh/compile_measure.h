// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include "artus/detail/anatomy/compile/labels/compile_report.h"
#include "artus/detail/anatomy/compile/labels/compile_surfaces.h"
#include "artus/detail/anatomy/compile/labels/region_labels.h"
#include "artus/detail/anatomy/compile/mesh/tet_topology.h"

namespace artus {

/// The share of its volume from which on a structure is said to lose much to those before it.
inline constexpr double kMuchLost = 0.2;
/// What of a bone may go to others without a word, m^3.
inline constexpr double kBoneLost = 0.02e-6;

/// Fills the measured part of `report` (structures: filler first, then file order; quality; counts)
/// from the finished mesh. Volumes expected of a structure are integrals over its field.
/// Distances are measured both ways: from the interfaces to the surfaces that shape them, and from
/// the surfaces, where nothing comes before them, to the interfaces of their regions.
/// Requires: the neighbours in `mesh` can be found. Cost: samples of all fields, exact distances of
/// four points of each interface and of points as near to each other as three samples of the field.
void measure_joint(const TetMesh& mesh, const RegionLabels& labels,
                   const PreparedSurfaces& surfaces, CompileReport& report);

/// The part of measure_joint that the labels alone tell: what each structure has in the region,
/// what it loses and to which. Cost: samples of all fields.
void measure_labels(const RegionLabels& labels, CompileReport& report);

/// The part of measure_joint that needs the mesh's interfaces: distances.
void measure_distances(const TetMesh& mesh, const RegionLabels& labels,
                       const PreparedSurfaces& surfaces, CompileReport& report);

/// The part of measure_joint that the mesh alone tells: volumes, parts, quality, counts.
void measure_mesh(const TetMesh& mesh, const TetNeighbours& neighbours, CompileReport& report);

}  // namespace artus
