// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <span>
#include <string_view>
#include <vector>

#include "artus/core/result.h"
#include "artus/detail/evidence/gate.h"

namespace artus {

/// needle, echo, realism, soft, injection, probe.
[[nodiscard]] std::span<const GateSet> gate_sets() noexcept;
/// All gates of all sets, in the order of the reports.
[[nodiscard]] std::span<const GateEntry> gate_entries() noexcept;

/// Errors: not_found, with the sets that there are.
[[nodiscard]] Result<const GateSet*> find_gate_set(std::string_view name);
[[nodiscard]] std::vector<std::string_view> gate_names(std::string_view set);
/// Those of a set that `options` have enough for.
[[nodiscard]] std::vector<std::string_view> gate_names(std::string_view set,
                                                       const GateOptions& options);

/// Measures one gate. Requires: a set that there is. Errors: not_found, with the names that there
/// are; malformed (what it needs is not given); those of check(NeedleFeel) (a law that it does not
/// take); those of the files that it reads.
[[nodiscard]] Result<Gate> run_gate(std::string_view set, std::string_view name,
                                    const GateOptions& options = {});

}  // namespace artus
