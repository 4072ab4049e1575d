// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstddef>
#include <future>
#include <memory>

#include "artus/detail/raycast/moving_scene.h"
#include "artus/detail/simulation/fluid_shapes.h"

namespace artus {

/// Scenes of the body with what was injected: where tissue gives way to the probe, so does what was
/// opened in it. One thread, which need not be the one that makes the shapes.
class FluidScene {
 public:
  /// `scenes`: that go round, see MovingScene.
  explicit FluidScene(std::size_t scenes = MovingScene::kGoingRound) : n_scenes_(scenes) {}

  /// Of one image; null: nothing was injected. `tissue`: the body as it gives way in it; null:
  /// rigid. Cost: one refit of the scene with tissue; a new index with a shape of other surfaces.
  [[nodiscard]] const std::shared_ptr<const Scene>& at(
      const FluidState& state, const std::shared_ptr<const DeformedBody>& tissue);

  /// Makes what the first shape will need before there is one, on a thread of its own, so that a
  /// live picture of the first drop need not wait. `body`: without it. Cost: none where that was
  /// done for the cage.
  void prepare(const Scene& body);

 private:
  [[nodiscard]] const std::shared_ptr<const BodyMap>& map_in(
      const std::shared_ptr<const FluidShape>& shape, const DeformedBody& tissue);

  std::shared_ptr<const FluidShape> mapped_;  // what map_ is of
  std::shared_ptr<const BodyMap> map_;        // in the present cage
  MovingScene scenes_;
  std::size_t n_scenes_;
  std::shared_ptr<const BodyMap> prepared_;  // what scenes_ was made ready for
  std::future<void> preparing_;
  FluidState placed_;  // what scene_ is of
  std::shared_ptr<const DeformedBody> placed_in_;
  std::shared_ptr<const Scene> scene_;
};

}  // namespace artus
