// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "artus/core/result.h"
#include "artus/detail/anatomy/import/imported_joint.h"

namespace artus {

/// Points of a surface.
using SurfaceSamples = std::vector<Vec3>;

/// About 1500 evenly chosen vertices of each structure: millimetres apart, which is enough to say
/// where a joint is.
[[nodiscard]] std::vector<SurfaceSamples> sample_structures(const ImportedJoint& joint);

/// The distance from `p` to the nearest sample, m.
[[nodiscard]] double distance_to(const SurfaceSamples& samples, const Vec3& p);

/// Where two surfaces are nearest.
struct Nearest {
  double distance = std::numeric_limits<double>::infinity();  ///< m
  Vec3 centre = Vec3::Zero();
};
[[nodiscard]] Nearest nearest_of(const SurfaceSamples& a, const SurfaceSamples& b);

/// Whether the boxes of two sets of points are farther apart than `reach`.
[[nodiscard]] bool are_apart(const SurfaceSamples& a, const SurfaceSamples& b, double reach);

/// The two structures that make the joint: those that `between` names, else of the bones within 15
/// mm of each other those whose smaller is largest. nullopt: there are no two. Errors: not_found (a
/// name of `between`).
[[nodiscard]] Result<std::optional<std::pair<std::size_t, std::size_t>>> find_joint_bones(
    const ImportedJoint& joint, const std::vector<std::string>& between,
    const std::vector<SurfaceSamples>& samples);

/// Evenly chosen vertices, about `n` of them.
[[nodiscard]] SurfaceSamples sample_surface(const SurfaceMesh& mesh, std::size_t n);

}  // namespace artus
