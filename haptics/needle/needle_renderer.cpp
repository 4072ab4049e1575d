// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/haptics/needle/needle_renderer.h"

#include <utility>

namespace artus {

NeedleRenderer::NeedleRenderer(std::shared_ptr<const Scene> scene, LayerTable table,
                               const NeedleParams& params, const GuardParams& guard,
                               const DeviceLimits& device, double rate_hz,
                               const PassivityParams& passivity)
    : scene_(std::move(scene)),
      table_(std::move(table)),
      dt_(1 / rate_hz),
      model_(params, table_, dt_),
      input_guard_(guard, dt_),
      output_guard_(guard, device, dt_),
      passivity_(passivity, dt_) {
  ARTUS_REQUIRE(scene_ != nullptr, "there must be a scene");
  ARTUS_REQUIRE(rate_hz >= 100 && rate_hz <= 20000, "the rate must be 100 to 20000 Hz");
}

const RenderedNeedle& NeedleRenderer::step(const TimedPose& pose) noexcept {
  rendered_.status = 0;
  const std::uint32_t faults = input_guard_.check(pose);
  if (faults == 0) {
    const QueryCount count = scene_->find_intervals(model_.query_segment(pose.X_JN), intervals_);
    rendered_.forces =
        model_.step(pose.X_JN, std::span<const TissueInterval>(intervals_.data(), count.size));
  } else {
    model_.reset();
    rendered_.forces = NeedleForces{};
    passivity_.pause();
  }
  Wrench wanted = rendered_.forces.total;
  if (faults == 0) wanted.force = passivity_.step(pose.X_JN.translation(), wanted.force);
  rendered_.command = output_guard_.apply(wanted, faults, rendered_.status);
  passivity_.observe(rendered_.command.force);
  rendered_.energy_to_hand = passivity_.energy_to_hand();
  if ((rendered_.status & TickStatus::kFaults) != 0 && faults == 0) model_.reset();
  return rendered_;
}

}  // namespace artus
