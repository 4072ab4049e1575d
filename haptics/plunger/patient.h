// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <string>

#include "artus/haptics/plunger/plunger.h"

namespace artus {

/// What the patient says while something is put into a place; a line of text for a window, empty
/// for nothing. Pain follows pressure and rate; assumed: the thresholds and words.
/// `tip`: the place that has most of the bevel.
[[nodiscard]] std::string patient_says(const Plunger& plunger, std::size_t tip);

}  // namespace artus
