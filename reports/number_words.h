// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <string>

#include "artus/detail/viewer/words/translation.h"

namespace artus {

/// What a metric's definition, filter or role says in English (compute_metrics), in `language`.
/// Text that it does not know stays as it is. Cost: one look through some 70 sentences.
[[nodiscard]] std::string number_words(Language language, const std::string& english);

}  // namespace artus
