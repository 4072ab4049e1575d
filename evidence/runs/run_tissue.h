// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <optional>
#include <vector>

#include "artus/detail/evidence/runs/three_injections.h"
#include "artus/detail/evidence/runs/three_injections_plan.h"
#include "artus/detail/simulation/fluid_shapes.h"
#include "artus/detail/simulation/tissue_core.h"

namespace artus {

/// Tissue that gives way in a run and the hand with the probe on it, tick by tick beside the
/// needle's: a session's own tissue and liquid (TissueCore, FluidShapes), one step an image, whose
/// answers both hands feel from the next tick on. The probe goes where the operator means to have
/// it next: to the plane of each planned line, lifted where that is beyond what a cage reaches, and
/// then in one of its own.
class RunTissue {
 public:
  /// Errors: those of TissueCore::make.
  [[nodiscard]] static Result<RunTissue> make(const Scene& scene,
                                              const std::array<InjectionPass, 3>& passes,
                                              const ThreeInjectionsOptions& options,
                                              const RunTissueOptions& tissue);

  /// A moment at `time`, s. `planned`: the operator had a name for it, and goes on to the next;
  /// otherwise it was met on the way. Returns where the probe is meant to be at it.
  Pose reach(double time, bool planned);

  /// The tick of the run's last row, whose needle puts `load` on the tissue; adds the probe's row.
  /// Whether it was an image's, after which packet() is another. Errors: those of TissueCore::make.
  Result<bool> step(const NeedleLoad& load, ThreeInjections& run);

  [[nodiscard]] const TissuePacket& packet() const noexcept { return core_.packet(); }
  [[nodiscard]] const std::shared_ptr<const Scene>& scene() const noexcept { return core_.scene(); }

 private:
  RunTissue(std::shared_ptr<const Scene> scene, std::vector<Pose> seats,
            const ThreeInjectionsOptions& options, const RunTissueOptions& tissue, TissueCore core);
  Result<void> follow(const Pose& X_JP);

  std::vector<Pose> seats_;  // in the order of what is planned
  std::size_t next_ = 0;
  std::vector<NamedMoment> known_;  // so far, and the one that is meant to be next
  RunTissueOptions options_;
  double rate_hz_;
  std::size_t images_ = 0;
  TissueCore core_;
  std::optional<FluidShapes> fluid_;  // empty: nothing was injected yet
  ProbeHand hand_;
};

}  // namespace artus
