// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <vector>

#include "artus/detail/soft/cage/cage.h"
#include "artus/detail/soft/cage/element.h"
#include "artus/detail/soft/cage/material.h"

namespace artus {

/// What a cube is made of, before its materials are averaged.
struct CellMixture {
  std::vector<int> samples;  ///< (n, n, n) material index at each sample, x fastest
  int n = 0;                 ///< samples along an edge, even
};

/// Samples of the field at the centres of n^3 parts of a cube.
[[nodiscard]] CellMixture sample_cell(const MaterialField& field, const Vec3& low_C, double edge,
                                      int n);

/// Share of the cube that is tissue, 0..1.
[[nodiscard]] double tissue_share(const CellMixture& mixture) noexcept;

/// The average of a cube. Where layers of different stiffness share a cube, a stiff thin one must
/// not make it a stiff block: shear across layers adds compliances (Reuss), stretch along them adds
/// stiffnesses (Voigt), which is exact for a pile of incompressible layers. The layers' normal is
/// where neighbouring samples differ most; where they differ in all directions alike, shear is
/// averaged half way (geometric mean by the spread). lambda adds compliances, and hardens
/// under the pressure under which the first of the materials does; what drains counts by its
/// share. Bone in a cube counts
/// as the stiffest soft tissue there, at least `hard_shear` (Pa): its nodes are held anyway.
[[nodiscard]] CellMaterial average_cell(const MaterialField& field, const CellMixture& mixture,
                                        double hard_shear = 0.7e6);

}  // namespace artus
