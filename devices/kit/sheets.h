// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <filesystem>
#include <string>

#include "artus/core/result.h"
#include "artus/detail/devices/kit/body.h"

namespace artus::kit {

enum class Paper { a4, letter };

/// Writes `markers.pdf` (to cut out and glue: probe, syringe, plunger, marks for the face),
/// `sheet.pdf` (under the block) and `board.pdf` (for the camera's calibration), each at true scale
/// with a ruler of 100 mm to check it. Errors: unreadable (cannot be written), failed (the library
/// of PDF says so).
[[nodiscard]] Result<void> write_sheets(const std::filesystem::path& folder, Paper paper,
                                        Hand hand);

/// The parts to print as STL in millimetres: `probe.stl`, `syringe.stl`, `plunger.stl`,
/// `divots.stl`. `barrel`: the syringe's diameter, m. Errors: unreadable.
[[nodiscard]] Result<void> write_parts(const std::filesystem::path& folder, Hand hand,
                                       double barrel);

}  // namespace artus::kit
