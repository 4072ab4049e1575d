// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "artus/detail/evidence/claim.h"
#include "artus/detail/training/health/body_health.h"

namespace artus {

/// That each measure of a body that has a value keeps its bound. `state`: of the body, in words:
/// "at rest", "pressed".
[[nodiscard]] std::vector<Claim> claims_of(const BodyHealth& health, const std::string& state);

}  // namespace artus
