// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/haptics/needle/needle_renderer.h"

#include <utility>

namespace artus {

NeedleRenderer::NeedleRenderer(std::shared_ptr<const Scene> scene, LayerTable table,
                               const NeedleRendererParams& params)
    : scene_(std::move(scene)),
      table_(std::move(table)),
      dt_(1 / params.rate_hz),
      model_(params.needle, table_, dt_),
      input_guard_(params.guard, dt_),
      output_guard_(params.guard, params.device, dt_),
      passivity_(params.passivity, dt_) {
  ARTUS_REQUIRE(scene_ != nullptr, "there must be a scene");
  ARTUS_REQUIRE(params.rate_hz >= 100 && params.rate_hz <= 20000,
                "the rate must be 100 to 20000 Hz");
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

Result<std::unique_ptr<NeedleRenderer>> make_needle_renderer(std::shared_ptr<const Scene> scene,
                                                             std::string_view device,
                                                             double rate_hz,
                                                             const NeedleFeel& feel) {
  ARTUS_REQUIRE(scene != nullptr, "there must be a scene");
  const auto limits = find_device(device);
  ARTUS_TRY(limits);
  if (!(rate_hz >= 100 && rate_hz <= 20000))
    return fail(ErrorCode::invalid, "the rate must be 100 to 20000 Hz", "rate");
  ARTUS_TRY(check(feel, scope_of(scene->joint())));
  NeedleRendererParams params;
  params.device = *limits;
  params.rate_hz = rate_hz;
  apply(feel, params.needle);
  apply(feel, params.passivity);
  LayerTable table = make_layer_table(scene->joint(), feel);
  return std::make_unique<NeedleRenderer>(std::move(scene), std::move(table), params);
}

}  // namespace artus
