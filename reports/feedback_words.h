// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <string>

#include "artus/detail/viewer/words/translation.h"

namespace artus {

/// What feedback says (Fault, Feedback) in a language: the sentence whose words are a row of the
/// table, with its numbers and structures in their places; as it is where there is no such row.
[[nodiscard]] std::string feedback_words(Language language, const std::string& english);

}  // namespace artus
