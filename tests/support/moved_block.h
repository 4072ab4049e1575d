// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "artus/detail/soft/solver/deformed_body.h"
#include "artus/detail/soft/solver/soft_block.h"
#include "tests/support/layered_body.h"

namespace artus::test {

/// A layered block, 96 mm x 96 mm, its top in z = 0, in a cage of cubes of 3 mm; its surfaces have
/// a vertex every 3 mm, in the cubes' corners where a layer's border is a multiple of that.
struct MovedBlock {
  std::shared_ptr<const CompiledJoint> joint;
  std::shared_ptr<const BodyMap> map;

  /// The block moved by `u`, which the cage knows at its nodes: exact for a field that is linear in
  /// each coordinate.
  [[nodiscard]] std::shared_ptr<const DeformedBody> moved(
      const std::function<Vec3(const Vec3&)>& u) const {
    std::vector<Vec3> nodes;
    for (const Vec3& p : map->model->cage().nodes()) nodes.push_back(u(p));
    return std::make_shared<const DeformedBody>(joint, map, nodes, ContactForce{});
  }
  [[nodiscard]] std::shared_ptr<const DeformedBody> at_rest() const {
    return moved([](const Vec3&) { return Vec3(Vec3::Zero()); });
  }
};

/// `change` edits the joint before it is used.
[[nodiscard]] inline MovedBlock make_moved_block(
    std::span<const FlatLayer> layers, const std::function<void(CompiledJoint&)>& change = {}) {
  constexpr double kHalf = 48e-3;
  CompiledJoint joint = subdivided(make_layered_block(layers, 2 * kHalf, 2 * kHalf), 5);
  if (change) change(joint);
  SoftBlock block;
  block.half_x = block.half_y = kHalf;
  block.quarter = false;
  block.layers.clear();
  for (const FlatLayer& layer : layers)
    block.layers.push_back({layer.thickness, linear_material(10e3, 0.47)});
  MovedBlock moved;
  moved.joint = std::make_shared<const CompiledJoint>(std::move(joint));
  moved.map = make_body_map(*moved.joint, Pose::Identity(), make_block_model(block, 3e-3));
  return moved;
}

}  // namespace artus::test
