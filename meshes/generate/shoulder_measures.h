// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <vector>

#include "artus/detail/meshes/generate/measures.h"
#include "artus/detail/meshes/generate/shoulder.h"

namespace artus {

/// Lengths taken along lines through the solids of make_shoulder. Cost: some seconds.
[[nodiscard]] std::vector<Measure> measure_shoulder(const ShoulderSize& size);

}  // namespace artus
