// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <optional>

#include "artus/anatomy/compiled_joint.h"
#include "artus/detail/echo/medium/material_map.h"

namespace artus {

/// Depth below the skin, with two coordinates along it: how septa are stacked in fat. Fitted to the
/// skin of the meshed body and what lies up to 24 mm below it. Empty for a body without tetrahedra
/// (a phantom) or without skin. Cost: some 20 ms.
[[nodiscard]] std::optional<MaterialMap> fit_skin_depth(const CompiledJoint& joint);

/// What goes on where a muscle's or a tendon's fibres leave it.
struct Continuation {
  RegionId region = kOutside;
  Vec3 p_J = Vec3::Zero();       ///< m, centre of the surface that both share
  Vec3 facing_J = Vec3::Zero();  ///< mean of its outward unit normals: short when it winds about
};

/// The tendon of a muscle, or the other way round: the one that shares most surface with `region`;
/// kOutside when there is none. Cost: linear in the interface triangles.
[[nodiscard]] Continuation find_continuation(const CompiledJoint& joint, RegionId region);

/// Coordinates along the fibres of one region: the potential flow through its tetrahedra from one
/// end to the other, which follows the surfaces of a bent or fanned structure (as fibres between
/// origin and insertion do), with sheets stacked away from the skin. Where muscle and tendon adjoin
/// they are taken as one. The ends are the eighths of the volume that reach farthest along its
/// fibre axis either way (its longest extent when it has none). Of FibreCourse::layer nothing is an
/// end: the potential grows along the part of the axis that lies beside the skin. `depth` is
/// fit_skin_depth's. Empty without tetrahedra: there fibres run straight. Cost: some 10 ms a
/// region. Source: Laplace flow between attachments, [Choi2013]; here by Ritz's method in
/// polynomials.
[[nodiscard]] std::optional<MaterialMap> fit_fibre_course(const CompiledJoint& joint,
                                                          RegionId region,
                                                          const std::optional<MaterialMap>& depth);

}  // namespace artus
