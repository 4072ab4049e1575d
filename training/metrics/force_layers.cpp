// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/training/metrics/force_layers.h"

#include <algorithm>

namespace artus {
namespace {
constexpr double kDeadTime = 0.3;  // s
}

ForceLayers::ForceLayers(std::size_t n_regions, std::size_t max_touches) : layers_(n_regions) {
  touches_.reserve(max_touches);
}

void ForceLayers::add(const FeltTick& tick) noexcept {
  if (!started_) {
    started_ = true;
    last_ = tick;
    moved_at_ = tick.time;
    return;
  }
  const double dt = tick.time - last_.time;
  const double moved = (tick.tip - last_.tip).norm();
  if (moved > 0 && tick.time > moved_at_) {  // poses may come more slowly than ticks
    speed_ = moved / (tick.time - moved_at_);
    moved_at_ = tick.time;
  }
  if (tick.region < layers_.size()) {
    LayerForce& layer = layers_[tick.region];
    layer.time += dt;
    layer.peak = std::max(layer.peak, tick.tissue);
    layer.impulse += tick.tissue * dt;
  }
  if (tick.on_bone && !last_.on_bone && tick.time - off_since_ >= kDeadTime) {
    ++count_;
    if (touches_.size() < touches_.capacity()) touches_.push_back({tick.time, 0, speed_, 0});
  }
  if (tick.on_bone && !touches_.empty()) {
    FeltTouch& touch = touches_.back();
    touch.peak = std::max(touch.peak, tick.hard);
    if (last_.on_bone) touch.scratch += moved;
  }
  if (!tick.on_bone && last_.on_bone) off_since_ = tick.time;
  last_ = tick;
}

}  // namespace artus
