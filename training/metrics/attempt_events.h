// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <vector>

#include "artus/detail/training/metrics/attempt_metrics.h"

namespace artus {

/// What happened, by time, each with its cause from the truth: first contact, runs advanced unseen
/// (why the tip was not seen), touches of bone, entries into zones, passes, idle times, placement.
[[nodiscard]] std::vector<AttemptEvent> find_events(const AttemptView& view);

}  // namespace artus
