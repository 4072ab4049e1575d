// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <vector>

#include "artus/detail/training/feedback.h"
#include "artus/detail/training/records.h"

namespace artus {

/// What the same person had finished without aids when an attempt began, oldest first, as feedback
/// wants it; `weeks` before the attempt's begin. Errors: those of Records. Cost: linear in the
/// person's numbers.
[[nodiscard]] Result<std::vector<PastAttempt>> read_past_attempts(Records& records,
                                                                  const AttemptRecord& attempt);

}  // namespace artus
