// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "artus/anatomy/compiled_joint.h"

/// Small layered bodies whose answers are known in closed form: the phantoms of echography and of
/// tests. They carry interfaces, regions and tissues, but no tetrahedra: whoever needs volumes
/// fills them with TetGen. Every builder takes the tissues to choose from by name, "gel" (the
/// outside) among them. Requires: every named tissue is one of `tissues`.
namespace artus {

/// One layer of a flat block, top first.
struct FlatLayer {
  std::string tissue;
  double thickness = 0;  ///< m
};

/// One sphere of a nest, outermost first.
struct SphereLayer {
  std::string tissue;  ///< of the shell between this sphere and the next one inside
  double radius = 0;   ///< m
};

/// The region with this name. Requires: there is one.
[[nodiscard]] RegionId region_named(const CompiledJoint& joint, std::string_view name);

/// A block of layers stacked along +z: the first layer's top face lies in z = 0 around `top_centre`
/// (frame J), so a probe at `top_centre` looking along +z sees the layers in order. Regions after
/// "outside" and "beyond" are named like their tissue; a tissue's second layer is "<tissue>_2".
[[nodiscard]] CompiledJoint make_layered_block(const std::vector<Tissue>& tissues,
                                               std::span<const FlatLayer> layers, double width_x,
                                               double depth_y,
                                               const Vec3& top_centre = Vec3::Zero());

/// A ball in a layer.
struct Ball {
  std::string tissue;
  Vec3 centre = Vec3::Zero();  ///< m
  double radius = 0;           ///< m
};

/// Puts a ball of 20 * 4^subdivisions triangles into `within`, as a region named like its tissue
/// (a second one "<tissue>_2"). Requires: it lies wholly in that region, beside other balls.
void add_ball(CompiledJoint& joint, const Ball& ball, RegionId within, int subdivisions = 3);

/// Spheres inside each other around `centre`: icosahedra split `subdivisions` times
/// (20 * 4^subdivisions triangles each), vertices on the spheres. Regions named as in
/// make_layered_block.
[[nodiscard]] CompiledJoint make_nested_spheres(const std::vector<Tissue>& tissues,
                                                std::span<const SphereLayer> layers,
                                                const Vec3& centre = Vec3::Zero(),
                                                int subdivisions = 4);

/// A block with a sphere inside. Requires: the sphere lies inside the block.
struct BlockWithSphere {
  std::string tissue;  ///< of the block
  Vec3 size = Vec3::Zero();
  Vec3 top_centre = Vec3::Zero();  ///< m, of the top face; the body lies along +z
  std::string inclusion;           ///< tissue of the sphere
  Vec3 centre = Vec3::Zero();      ///< m
  double radius = 0;               ///< m
  int subdivisions = 4;            ///< of the sphere, as in make_nested_spheres
};

/// Regions: "block", "inclusion".
[[nodiscard]] CompiledJoint make_block_with_sphere(const std::vector<Tissue>& tissues,
                                                   const BlockWithSphere& block);

/// The joint with each triangle of its interfaces cut into four, `times` over: a body without
/// tetrahedra whose flat surfaces can bend. Requires: no tetrahedra.
[[nodiscard]] CompiledJoint subdivided(const CompiledJoint& joint, int times);

/// The joint moved rigidly: vertices, landmarks, default poses and fibre axes.
[[nodiscard]] CompiledJoint transformed(const CompiledJoint& joint, const Pose& X_new_old);

}  // namespace artus
