// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <filesystem>
#include <span>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "artus/detail/core/plot.h"
#include "artus/detail/evidence/claim.h"
#include "artus/detail/evidence/runs/injection_run.h"

namespace artus {

/// What a run must show whatever it injected, and where: volumes that balance, a needle that
/// reached its place, and into a bursa, joint or sheath at least 95 % of what was given.
[[nodiscard]] std::vector<Claim> claims_of(const InjectionRun& run);

/// m^3/s, mean over the time of the push in which it flowed; 0: never.
[[nodiscard]] double mean_flow(const InjectionRun& run);

/// What was asked for and not done, a sentence each: a rate below four fifths of it, a volume.
[[nodiscard]] std::vector<std::string> notes_of(const InjectionRun& run);

/// Places, volumes, pressures, forces, the patient's words and claims, in the units of the names.
[[nodiscard]] nlohmann::json summarize(const InjectionRun& run);

/// Thumb's force, pressures, flow and volumes over time.
[[nodiscard]] Plot plot_of(const InjectionRun& run);

/// Several runs beside each other from the moment at which each pushes: force, pressure, volume.
[[nodiscard]] Plot plot_of(std::span<const InjectionRun> runs);

/// Writes trace.csv and injection.svg into `folder` (made when missing). Errors: unreadable.
[[nodiscard]] Result<void> write_injection(const InjectionRun& run,
                                           const std::filesystem::path& folder);

}  // namespace artus
