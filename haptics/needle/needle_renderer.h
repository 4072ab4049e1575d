// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <memory>
#include <string_view>

#include "artus/haptics/guard.h"
#include "artus/haptics/needle/needle_feel.h"
#include "artus/haptics/needle/needle_model.h"
#include "artus/haptics/passivity.h"

namespace artus {

/// One tick's result: what to send, and why.
struct RenderedNeedle {
  Wrench command;             ///< within the device's limits, safe to send
  NeedleForces forces;        ///< the components before limits; zero on a fault
  std::uint32_t status = 0;   ///< TickStatus bits
  double energy_to_hand = 0;  ///< J given since the start, by the passivity observer
};

/// What a renderer is made of besides its scene.
struct NeedleRendererParams {
  NeedleParams needle;
  GuardParams guard;
  PassivityParams passivity;
  DeviceLimits device;    ///< whose limits the command is kept in
  double rate_hz = 1000;  ///< ticks a second, 100 to 20000
};

/// The complete haptic tick of the needle against one scene: input guard, scene query, force laws,
/// output guard. The period is fixed, so a replay of the same poses gives the same bytes.
class NeedleRenderer {
 public:
  /// Requires: a scene; rate in [100, 20000] Hz.
  NeedleRenderer(std::shared_ptr<const Scene> scene, LayerTable table,
                 const NeedleRendererParams& params);
  NeedleRenderer(const NeedleRenderer&) = delete;
  NeedleRenderer& operator=(const NeedleRenderer&) = delete;
  ~NeedleRenderer() = default;

  /// Errors: none; any input gives a wrench within limits and says in the status what was wrong.
  ARTUS_REALTIME const RenderedNeedle& step(const TimedPose& pose) noexcept;

  [[nodiscard]] const NeedleModel& model() const noexcept { return model_; }
  [[nodiscard]] double period() const noexcept { return dt_; }  ///< s

 private:
  static constexpr std::size_t kMaxIntervals = 64;

  std::shared_ptr<const Scene> scene_;
  LayerTable table_;
  double dt_;
  NeedleModel model_;
  InputGuard input_guard_;
  OutputGuard output_guard_;
  PassivityObserver passivity_;
  std::array<TissueInterval, kMaxIntervals> intervals_{};
  RenderedNeedle rendered_;
};

/// A renderer of the published laws, as far as `feel` does not change them. `device`: a name of
/// device_table(). Errors: not_found (device, tissue in `feel`), invalid (rate, a value in `feel`).
[[nodiscard]] Result<std::unique_ptr<NeedleRenderer>> make_needle_renderer(
    std::shared_ptr<const Scene> scene, std::string_view device, double rate_hz,
    const NeedleFeel& feel = {});

}  // namespace artus
