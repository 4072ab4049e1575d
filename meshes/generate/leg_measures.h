// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <vector>

#include "artus/detail/meshes/generate/hip.h"
#include "artus/detail/meshes/generate/knee.h"
#include "artus/detail/meshes/generate/measures.h"

namespace artus {

/// Lengths and angles taken along lines through the solids of make_knee. Cost: a second.
[[nodiscard]] std::vector<Measure> measure_knee(const KneeSize& size);

/// The same of make_hip.
[[nodiscard]] std::vector<Measure> measure_hip(const HipSize& size);

}  // namespace artus
