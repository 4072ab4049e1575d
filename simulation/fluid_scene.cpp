// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/simulation/fluid_scene.h"

#include <array>
#include <chrono>
#include <utility>

namespace artus {
namespace {

/// Where the shape's surfaces lie in the tissue's cage; in one that was changed since, elsewhere.
bool is_in(const std::shared_ptr<const FluidShape>& shape, const DeformedBody& tissue) {
  return shape->map && shape->map->model == tissue.map().model;
}

}  // namespace

const std::shared_ptr<const BodyMap>& FluidScene::map_in(
    const std::shared_ptr<const FluidShape>& shape, const DeformedBody& tissue) {
  if (is_in(shape, tissue)) return shape->map;
  if (mapped_ != shape || map_->model != tissue.map().model)
    map_ = make_body_map(*shape->joint, std::array{tissue.mapped()});
  mapped_ = shape;
  return map_;
}

/// Indices of the scenes that go round: a shape that opens a space has the body's surfaces. They
/// are shared whether or not an earlier thread is done, on which no byte of a picture may depend.
void FluidScene::prepare(const Scene& body) {
  const std::shared_ptr<const DeformedBody>& tissue = body.tissue();
  if (!tissue) return;
  scenes_.share(body);
  if (tissue->shared_map() == prepared_) return;
  if (preparing_.valid() &&
      preparing_.wait_for(std::chrono::seconds(0)) != std::future_status::ready)
    return;
  prepared_ = tissue->shared_map();
  preparing_ = std::async(std::launch::async, [scenes = scenes_, tissue, n = n_scenes_] {
    scenes.make_ahead(tissue, n);
  });
}

const std::shared_ptr<const Scene>& FluidScene::at(
    const FluidState& state, const std::shared_ptr<const DeformedBody>& tissue) {
  const bool same = placed_.shape == state.shape && placed_.before == state.before &&
                    placed_.part == state.part && placed_in_ == tissue;
  if (same) return scene_;
  placed_ = state;
  placed_in_ = tissue;
  if (!state.shape) {
    scene_ = nullptr;
    return scene_;
  }
  if (!tissue) {
    scene_ =
        state.shape->scene ? state.shape->scene : std::make_shared<const Scene>(state.shape->joint);
    return scene_;
  }
  const auto body_of = [&](const std::shared_ptr<const FluidShape>& shape) {
    return std::make_shared<const DeformedBody>(shape->joint, map_in(shape, *tissue),
                                                tissue->node_displacements(), tissue->contact());
  };
  std::shared_ptr<const DeformedBody> body = body_of(state.shape);
  if (state.before && is_in(state.before, *tissue) && is_in(state.shape, *tissue))
    body = body->come_from(*body_of(state.before), state.part);
  scene_ = scenes_.at(std::move(body));
  return scene_;
}

}  // namespace artus
