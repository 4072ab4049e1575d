// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <string>

#include "artus/detail/training/scenario.h"
#include "artus/raycast/scene.h"

namespace artus {

/// The scenario with another patient, in its text too, as a record keeps it. Errors: invalid for
/// one without a joint.
[[nodiscard]] Result<Scenario> of_patient(const Scenario& scenario, const std::string& patient);

/// Moves the plans of a scenario that has a patient from where the joint was modelled to where this
/// body is: the probe along its beam and the entry along the needle's path onto the skin, the point
/// aimed at to the middle of the target's stretch of that path when it lies outside of the target.
/// Without a patient, or in a body that is at the plans already, nothing moves. Cost: one pass over
/// the interfaces.
void follow_patient(Scenario& scenario, const Scene& scene);

}  // namespace artus
