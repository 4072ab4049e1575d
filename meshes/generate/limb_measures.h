// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <vector>

#include "artus/detail/meshes/generate/ankle.h"
#include "artus/detail/meshes/generate/elbow.h"
#include "artus/detail/meshes/generate/measures.h"
#include "artus/detail/meshes/generate/wrist.h"

namespace artus {

/// Lengths and areas taken through the solids of make_elbow. Cost: a second.
[[nodiscard]] std::vector<Measure> measure_elbow(const ElbowSize& size);

/// The same of make_wrist.
[[nodiscard]] std::vector<Measure> measure_wrist(const WristSize& size);

/// The same of make_ankle.
[[nodiscard]] std::vector<Measure> measure_ankle(const AnkleSize& size);

}  // namespace artus
