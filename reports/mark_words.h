// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <string>

#include "artus/detail/training/judgement.h"
#include "artus/detail/training/scenario.h"
#include "artus/detail/viewer/words/translation.h"

namespace artus {

/// A metric in words, with its unit; its name where there are none.
[[nodiscard]] std::string metric_words(Language language, const std::string& metric);
/// What a mark asks for: "at most 2".
[[nodiscard]] std::string bound_words(Language language, const Mark& mark);
/// "tip from the target, mm: at most 2".
[[nodiscard]] std::string mark_words(Language language, const Mark& mark);
/// A scenario's title; the English one where it has none in the language.
[[nodiscard]] const std::string& title_words(Language language, const Scenario& scenario);

}  // namespace artus
