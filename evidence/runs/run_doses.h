// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <span>

#include "artus/detail/evidence/runs/three_injections.h"
#include "artus/simulation/simulation.h"

namespace artus {

/// The syringe in a tick of a run.
[[nodiscard]] SyringeRow make_syringe_row(const HapticSnapshot& tick);

/// Where the liquid is at a run's end, and its balance, into `out`. A place is a target when one of
/// `targets` is in it.
void sum_up_doses(const Simulation& simulation, std::span<const RegionId> targets,
                  ThreeInjections& out);

/// Claims of what was given: the balance, and where a target is a bursa or joint how much came
/// there. None of a dry run.
void claim_doses(ThreeInjections& run);

}  // namespace artus
