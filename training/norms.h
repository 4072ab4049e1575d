// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <span>
#include <string>
#include <vector>

#include "artus/detail/training/records.h"

namespace artus {

/// Attempts below which a group's numbers are no norm.
inline constexpr int kFewestForNorm = 10;

/// The group whose norms stand beside a learner's numbers.
inline constexpr const char* kExperts = "experts";

/// Each metric's norm over the attempts that have it, `kFewestForNorm` or more of them; by role
/// and name. Percentiles by nearest rank; sd with n - 1. Cost: sorts the values.
[[nodiscard]] std::vector<Norm> compute_norms(std::span<const MetricValue> values);

/// Makes the norms of a scenario anew from the finished attempts without aids of the group's
/// learners (`group`: their cohort), of the scenario's newest text, and keeps them. Errors: invalid
/// (fewer attempts than it takes), those of Records.
[[nodiscard]] Result<std::vector<Norm>> renew_norms(Records& records, const std::string& scenario,
                                                    const std::string& group);

}  // namespace artus
