// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <memory>
#include <span>

#include "artus/detail/evidence/runs/three_injections.h"

namespace artus {

/// Where the hand means to have the probe at `t` s: at each moment on its seat, sliding in between
/// or, where that is `far` m away or turned by 30 degrees, lifted; lifted before the first and
/// after the last. Requires: a moment.
[[nodiscard]] ProbeIntention intend_probe(std::span<const NamedMoment> moments, double t,
                                          double far);

/// Lets the probe hand press the probe on the skin during the run, its plane in each insertion line
/// in turn, and fills `run.probe` (one row per needle row) and the moments' probe. Requires: rows
/// and moments of a run in rigid tissue.
void run_probe_hand(const std::shared_ptr<const Scene>& scene, ThreeInjections& run);

/// What must hold of the probe whatever the body. In one that gives way (`gives_way`) one hand may
/// lift the other, a needle drawn out the probe, so that energy is claimed of both together.
void claim_probe(ThreeInjections& run, bool gives_way);

}  // namespace artus
