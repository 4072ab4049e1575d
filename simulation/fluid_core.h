// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <utility>

#include "artus/detail/simulation/fluid_scene.h"
#include "artus/detail/simulation/fluid_shapes.h"

namespace artus {

/// What a session's liquid makes of the body, image by image, in one thread: shapes and scenes.
class FluidCore {
 public:
  /// As FluidShapes.
  FluidCore(std::shared_ptr<const CompiledJoint> joint, Liquid liquid, double image_rate)
      : shapes_(std::move(joint), std::move(liquid), image_rate) {}

  /// The scene of the next image; null: nothing was injected. `tissue`: the body as it gives way in
  /// this image; null: rigid. Cost: FluidScene::at; waits where a shape is due and not ready.
  [[nodiscard]] const std::shared_ptr<const Scene>& step(
      std::span<const InjectedSite> sites, const std::shared_ptr<const DeformedBody>& tissue) {
    const FluidState& state = shapes_.step(sites);
    shapes_.follow(sites, tissue);
    return scene_.at(state, tissue);
  }

  [[nodiscard]] std::uint64_t images_to_change() const noexcept {
    return shapes_.images_to_change();
  }

 private:
  FluidShapes shapes_;
  FluidScene scene_;
};

}  // namespace artus
