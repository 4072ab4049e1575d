// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <string>

#include "artus/detail/viewer/words/translation.h"

namespace artus {

/// What the session's threads say of the system (Session::refusals(), Session::notices(),
/// Session::device_name()), in the window's language; names and numbers in it stay. What the table
/// does not know stays as it was said. Cost: one look through some 30 rows. Errors: none.
[[nodiscard]] std::string said_by_system(Language language, const std::string& english);

}  // namespace artus
