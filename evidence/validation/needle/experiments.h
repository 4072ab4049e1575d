// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include "artus/detail/evidence/validation/needle/experiment.h"
#include "artus/detail/evidence/validation/needle/experiment_body.h"
#include "artus/haptics/device.h"

/// The needle experiments themselves, one function each; gates.h runs them by name, as
/// measure_experiment does.
namespace artus {

/// Fig 2-4: direct, spring, Voigt and tracking wall on one tissue; stop, then the hand lets go.
[[nodiscard]] Experiment run_wall_vs_classic(const ExperimentOptions&, const DeviceLimits&);
/// Stop, then let go at once or slowly: with the wall alone, with friction, and without tissue.
[[nodiscard]] Experiment run_wall_release(const ExperimentOptions&, const DeviceLimits&);
/// Fig 2-5: the force rises over 2 mm to 1 N and stays.
[[nodiscard]] Experiment run_wall_move(const ExperimentOptions&, const DeviceLimits&);
/// Fig 2-6: the force settles to 0 after a stop and builds again.
[[nodiscard]] Experiment run_wall_stop(const ExperimentOptions&, const DeviceLimits&);
/// Fig 2-10: cutting on the way in, attracted on the way out.
[[nodiscard]] Experiment run_wall_both(const ExperimentOptions&, const DeviceLimits&);
/// Fig 2-13: nine layers in a ball, oblique.
[[nodiscard]] Experiment run_wall_nine(const ExperimentOptions&, const DeviceLimits&);
/// Fig 2-15: seven layers, attracted 0.7 N.
[[nodiscard]] Experiment run_wall_seven(const ExperimentOptions&, const DeviceLimits&);
/// Figs 2-16, 2-17: off the line, withdraw, re-aim, insert, withdraw.
[[nodiscard]] Experiment run_clamp_redirect(const ExperimentOptions&, const DeviceLimits&);
/// 10 000 random insertion histories over six layers: energy given over each closed cycle.
[[nodiscard]] Experiment run_wall_energy(const ExperimentOptions&, const DeviceLimits&);
/// The same insertions at 1, 2 and 10 kHz.
[[nodiscard]] Experiment run_insertions_at_rates(const ExperimentOptions&, const DeviceLimits&);
/// The same, and a hand that sways.
[[nodiscard]] Experiment run_rates(const ExperimentOptions&, const DeviceLimits&);
/// Noise and lag of every velocity estimator.
[[nodiscard]] Experiment run_velocity_estimators(const ExperimentOptions&, const DeviceLimits&);
/// Each pair of layers of table 4.2: force step and rise distance against what a hand can tell.
[[nodiscard]] Experiment run_layer_changes(const ExperimentOptions&, const DeviceLimits&);

/// An experiment's own assumptions, and those of every one that runs a hand on a device.
[[nodiscard]] std::vector<std::string> assumed_with_hand(std::vector<std::string> own);

/// The layers of table 4.2, skin to bone, as the experiments on them name them.
[[nodiscard]] std::vector<std::string> table_layer_names();

/// Resistance as the source plots it: N, positive against insertion, negative on withdrawal.
[[nodiscard]] inline double resistance(const NeedleRow& row) noexcept {
  return -(row.forces.cutting + row.forces.attracted);
}

}  // namespace artus
