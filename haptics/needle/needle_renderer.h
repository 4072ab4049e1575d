// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <memory>
#include <string_view>

#include "artus/detail/haptics/needle/needle_tick_step.h"
#include "artus/haptics/needle_feel.h"

namespace artus {

/// The needle's tick against a scene.
class NeedleRenderer {
 public:
  /// Requires: a scene; rate in [100, 20000] Hz.
  NeedleRenderer(std::shared_ptr<const Scene> scene, LayerTable table,
                 const NeedleRendererParams& params);

  /// Errors: none; any input gives a wrench within limits and says in the status what was wrong.
  ARTUS_REALTIME const RenderedNeedle& step(const TimedPose& pose) noexcept {
    return tick_.step(pose, *scene_);
  }

  /// NeedleTickStep::feel and command.
  ARTUS_REALTIME bool feel(const TimedPose& pose) noexcept { return tick_.feel(pose, *scene_); }
  ARTUS_REALTIME const RenderedNeedle& command(const Vec3& more = Vec3::Zero()) noexcept {
    return tick_.command(more);
  }

  /// NeedleModel::take.
  ARTUS_REALTIME void take(const NeedlePacket& packet) noexcept { tick_.take(packet); }

  [[nodiscard]] const NeedleModel& model() const noexcept { return tick_.model(); }
  [[nodiscard]] const LayerTable& table() const noexcept { return tick_.table(); }
  /// J given since the start, by the passivity observer.
  [[nodiscard]] double energy_to_hand() const noexcept { return tick_.energy_to_hand(); }
  [[nodiscard]] double period() const noexcept { return tick_.period(); }  ///< s

 private:
  std::shared_ptr<const Scene> scene_;
  NeedleTickStep tick_;
};

/// A renderer of the published laws, as far as `feel` does not change them. `device`: a name of
/// device_table(). Errors: not_found (device, tissue in `feel`), invalid (rate, a value in `feel`).
[[nodiscard]] Result<std::unique_ptr<NeedleRenderer>> make_needle_renderer(
    std::shared_ptr<const Scene> scene, std::string_view device, double rate_hz,
    const NeedleFeel& feel = {});

}  // namespace artus
