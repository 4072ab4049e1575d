// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include "artus/detail/evidence/gates.h"

namespace artus {

/// The syringe and the places that liquid goes to. Cost of a gate: below 2 s.
[[nodiscard]] const GateSet& injection_gates() noexcept;

}  // namespace artus
