// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <filesystem>

#include "artus/core/result.h"
#include "artus/detail/evidence/gate.h"

/// Whether a picture passes for a scanner's: statistics of the clinical look on test objects, in
/// bands taken from published pictures of three scanners, and plates beside them. All claims are
/// fitted: the look was tuned in these bands.
namespace artus {

/// Bone's line at any slope, and the shadow below it: a coarse ball of bone in muscle.
[[nodiscard]] Gate gate_screen_bone();
/// Contrast of a needle by its angle to the face, relative to one that lies along it.
[[nodiscard]] Gate gate_screen_needle();
/// Grey of a lumen in muscle.
[[nodiscard]] Gate gate_screen_lumen();
/// Grey and grain of muscle along its fibres.
[[nodiscard]] Gate gate_screen_muscle();

/// Our pictures beside real ones at one scale. `folder` holds them (plus_bone, timtrack_more,
/// usgra). Errors: not_found, unreadable, naming the file.
[[nodiscard]] Result<Gate> measure_plates(const std::filesystem::path& folder);

}  // namespace artus
