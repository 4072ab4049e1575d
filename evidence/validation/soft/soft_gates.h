// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include "artus/detail/evidence/gates.h"

namespace artus {

/// The mechanics of tissue that gives way, on blocks. Cost of a gate: 0.1 to 60 s.
[[nodiscard]] const GateSet& soft_gates() noexcept;

}  // namespace artus
