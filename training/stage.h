// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <memory>

#include "artus/detail/training/player.h"

namespace artus {

/// Simulated hands and the session that they work in, tick by tick without a clock.
class Stage {
 public:
  virtual ~Stage() = default;
  /// One tick of 1 ms, measured and recorded. False when the hands are done.
  virtual bool step(PlayedAttempt& attempt, AttemptMeter& meter) = 0;
  [[nodiscard]] virtual double time() const noexcept = 0;  ///< s

 protected:
  Stage() = default;
  Stage(const Stage&) = default;
  Stage& operator=(const Stage&) = default;
};

/// The hands that a scenario asks for: both with a needle, or the probe's alone. Requires: what
/// make_meter_options accepts.
[[nodiscard]] std::unique_ptr<Stage> make_stage(const Scenario& scenario,
                                                std::shared_ptr<const Scene> scene,
                                                const SessionParams& params,
                                                const OperatorSkill& skill,
                                                const PlayOptions& options);

}  // namespace artus
