// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <memory>

#include "artus/detail/training/player.h"

namespace artus {

/// Simulated hands in a simulation, tick by tick without a clock.
class SimulatedAttempt {
 public:
  virtual ~SimulatedAttempt() = default;
  /// One tick of 1 ms, measured and recorded. False when the hands are done.
  virtual bool step(AttemptMeter& meter) = 0;
  [[nodiscard]] virtual double time() const noexcept = 0;  ///< s
  /// The body as it is now, with liquid and without; see draw_health_question. The hands are done:
  /// no step may follow. Cost: an image.
  [[nodiscard]] virtual std::optional<HealthQuestion> find_body() { return std::nullopt; }

 protected:
  SimulatedAttempt() = default;
  SimulatedAttempt(const SimulatedAttempt&) = default;
  SimulatedAttempt& operator=(const SimulatedAttempt&) = default;
};

/// The hands that a scenario asks for: both with a needle, or the probe's alone. Requires: what
/// make_meter_options accepts. `recording` outlives it.
[[nodiscard]] std::unique_ptr<SimulatedAttempt> make_simulated_attempt(
    const Scenario& scenario, std::shared_ptr<const Scene> scene, const SessionParams& params,
    const OperatorSkill& skill, const PlayOptions& options, Recording& recording);

}  // namespace artus
