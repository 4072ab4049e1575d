// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <optional>
#include <span>

#include "artus/detail/simulation/syringe_core.h"
#include "artus/detail/training/health/body_health.h"
#include "artus/simulation/simulation.h"

namespace artus {

/// Spaces that liquid is in and tissues that it parts, by what a drawn body has beside the one at
/// rest: they may be more than where it came in, since a full space gives to what is around, and
/// what parts tissue beside a space tears into it.
void add_drawn(const CompiledJoint& rest, const CompiledJoint& drawn, GivenLiquid& liquid);

/// The body of a simulation whose hands stay as they were in the image `shown`, its newest, until
/// all that was given is drawn (4 s at most: shapes follow liquid and press), beside the same
/// without liquid, under the same press. Holds the two scenes, which the simulation goes on to
/// move: measure before its next image. Empty: nothing is drawn of liquid. Cost: some images'
/// tissue, a picture.
[[nodiscard]] std::optional<HealthQuestion> find_health_question(Simulation& simulation,
                                                                 const FrameInput& shown);

/// The same at the end of a loop. Empty in a rigid body, too.
[[nodiscard]] std::optional<HealthQuestion> draw_health_question(Simulation& simulation);

}  // namespace artus
