// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstdint>
#include <vector>

#include "artus/detail/anatomy/compile/labels/distance_field.h"
#include "artus/detail/anatomy/surfaces/surface_mesh.h"

namespace artus {

/// Which faces of a repaired body close a flat cut of the surface as it was read (an export that
/// cropped it, a body cut mid-sagittally), so that they are no skin: (n_triangles of `repaired`),
/// 1 where a face does; empty where there is no such cut. Faces away from the surface as read (2
/// mm) that hang together, are flat and have 1 cm^2 or more; a hole that is filled as the skin
/// around it is bent stays skin. Cost: a distance for each face of `repaired`.
[[nodiscard]] std::vector<std::uint8_t> find_cut_faces(const SurfaceMesh& read,
                                                       const SurfaceMesh& repaired);

/// The same of a body whose author gives its cuts as a surface: 1 where a face of `body` lies on it
/// (its middle within 10 um). Cost: a distance for each face.
[[nodiscard]] std::vector<std::uint8_t> find_given_cuts(const SurfaceMesh& body,
                                                        const SurfaceMesh& cuts);

/// The faces of `mesh` that are no cut (or, with `cut`, those that are); all of them where
/// `is_cut` is empty. The vertices are those of `mesh`.
[[nodiscard]] SurfaceMesh without_cuts(const SurfaceMesh& mesh,
                                       const std::vector<std::uint8_t>& is_cut, bool cut = false);

/// A mesh without the triangles that do not reach into a box.
[[nodiscard]] SurfaceMesh part_near(const Box& box, SurfaceMesh mesh);

}  // namespace artus
