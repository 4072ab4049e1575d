// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <span>

#include "artus/core/result.h"
#include "artus/detail/anatomy/import/imported_joint.h"
#include "artus/detail/anatomy/surfaces/surface_mesh.h"

namespace artus {

/// A round tube of `radius` (m) along a smooth curve (centripetal Catmull-Rom) through `points`
/// (m), with round ends: closed, wound outward. Errors: invalid, naming `where` (fewer than two
/// points, points that are not finite or less than 0.1 mm apart, a radius that is not from 0.2 to
/// 30 mm, a bend that is sharper than the radius: with its place). Cost: linear.
[[nodiscard]] Result<SurfaceMesh> sweep_tube(std::span<const Vec3> points, double radius,
                                             const std::string& where);

/// Adds the nerves and vessels that a person typed, [[tube]] of the file of names, to an imported
/// joint: first of its structures, so that they keep their place, and marked as assumed. Errors:
/// those of sweep_tube; invalid (a name that there is).
[[nodiscard]] Result<void> add_tubes(ImportedJoint& joint, std::span<const NamedTube> tubes);

}  // namespace artus
