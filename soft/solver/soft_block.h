// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <memory>
#include <vector>

#include "artus/detail/soft/solver/face_contact.h"
#include "artus/detail/soft/solver/soft_model.h"

/// Blocks of layers whose answers are known: what gates and tests press. Frame C: the top face lies
/// in z = 0 around the origin, the body along +z, as a probe at the identity sees it.
namespace artus {

struct SoftLayer {
  double thickness = 0;  ///< m
  SoftMaterial material;
};

struct SoftBlock {
  std::vector<SoftLayer> layers;  ///< top first
  double half_x = 0.05;           ///< m
  double half_y = 0.05;           ///< m
  /// A quarter, x and y >= 0, that mirrors itself at x = 0 and y = 0.
  bool quarter = false;
  bool walls = true;  ///< the sides are held, otherwise free; the bottom is held always
};

/// Lame's constants of a material without hardening.
[[nodiscard]] SoftMaterial linear_material(double youngs_modulus, double poisson_ratio);

[[nodiscard]] double thickness_of(const SoftBlock& block);

[[nodiscard]] MaterialField make_field(const SoftBlock& block);

/// The model with cubes of `cell` and the zones given.
[[nodiscard]] std::shared_ptr<const SoftModel> make_block_model(const SoftBlock& block, double cell,
                                                                std::vector<CageZone> zones = {});

/// The top face as a grid of squares of `spacing`, two triangles each.
[[nodiscard]] SkinPatch make_flat_skin(const SoftBlock& block, double spacing);

/// The layers' thicknesses at (x, y) under displacements `u`, m.
[[nodiscard]] std::vector<double> layer_thicknesses(const SoftBlock& block, const SoftModel& model,
                                                    std::span<const Vec3> u, double x, double y);

}  // namespace artus
