// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/haptics/needle_renderer.h"

#include <utility>

namespace artus {

NeedleRenderer::NeedleRenderer(std::shared_ptr<const Scene> scene, LayerTable table,
                               const NeedleRendererParams& params)
    : scene_(std::move(scene)), tick_(std::move(table), params) {
  ARTUS_REQUIRE(scene_ != nullptr, "there must be a scene");
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
