// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <span>
#include <vector>

#include "artus/detail/echo/acquire/liquid_plume.h"
#include "artus/detail/evidence/runs/injection_run.h"
#include "artus/echo/renderer.h"

namespace artus {

/// What drifts in the liquid of an injection, from one picture to the next.
class InjectionPlume {
 public:
  /// Requires: `run` outlives this object. `bore`: m.
  InjectionPlume(const Scene& scene, const InjectionRun& run, double bore);

  /// The points at `time` of the run, s, in the body of then; times must rise. Steps of a thirtieth
  /// of a second; of a longer pause only the last 6 s are followed.
  [[nodiscard]] std::span<const DriftingPoint> at(const Scene& body, double time);
  /// The same, and what has settled, in the next picture of `renderer`, which shows that body.
  void show(Renderer& renderer, const Scene& body, double time);

 private:
  [[nodiscard]] PlumeSource source_at(double time) const;

  const InjectionRun* run_;
  double bore_;
  std::vector<bool> holds_;  // of the run's places: not a vessel, not the air
  LiquidPlume plume_;
  double time_ = 0;
};

}  // namespace artus
