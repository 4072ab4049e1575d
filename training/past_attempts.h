// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <ctime>
#include <string>
#include <vector>

#include "artus/training/feedback.h"
#include "artus/training/records.h"

namespace artus {

/// A person's finished attempts without aids, oldest first, as feedback wants them. `now`: UTC.
/// Errors: those of Records. Cost: linear in the person's numbers.
[[nodiscard]] Result<std::vector<PastAttempt>> read_past_attempts(Records& records,
                                                                  const std::string& person,
                                                                  std::time_t now);

}  // namespace artus
