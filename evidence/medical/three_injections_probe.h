// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <memory>

#include "artus/evidence/medical/three_injections.h"

namespace artus {

/// Lets the probe hand press the probe on the skin during the run, its plane in each insertion line
/// in turn, and fills `run.probe` (one row per needle row) and the moments' probe. Requires: rows
/// and moments of a run.
void run_probe_hand(const std::shared_ptr<const Scene>& scene, ThreeInjections& run);

/// What must hold of the probe whatever the body.
void claim_probe(ThreeInjections& run);

}  // namespace artus
