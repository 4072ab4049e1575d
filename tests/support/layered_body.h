// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "artus/detail/anatomy/body/layered_body.h"

/// The layered bodies of anatomy/layered_body.h made of test tissues.
namespace artus::test {

using artus::BlockWithSphere;
using artus::FlatLayer;
using artus::region_named;
using artus::SphereLayer;
using artus::transformed;

/// gel, skin, fat, muscle, bursa, tendon, cartilage, bone, in this order. Acoustic values as the
/// literature's tissue table gives them, cutting forces of [Alamilla2020] table 4.2; backscatter,
/// roughness, fat's haptics and the other haptic values are assumed: tests need some value.
[[nodiscard]] std::vector<Tissue> make_test_tissues();

[[nodiscard]] inline CompiledJoint make_layered_block(std::span<const FlatLayer> layers,
                                                      double width_x, double depth_y,
                                                      const Vec3& top_centre = Vec3::Zero()) {
  return artus::make_layered_block(make_test_tissues(), layers, width_x, depth_y, top_centre);
}

[[nodiscard]] inline CompiledJoint make_nested_spheres(std::span<const SphereLayer> layers,
                                                       const Vec3& centre = Vec3::Zero(),
                                                       int subdivisions = 4) {
  return artus::make_nested_spheres(make_test_tissues(), layers, centre, subdivisions);
}

[[nodiscard]] inline CompiledJoint make_block_with_sphere(const BlockWithSphere& block) {
  return artus::make_block_with_sphere(make_test_tissues(), block);
}

}  // namespace artus::test
