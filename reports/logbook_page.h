// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <filesystem>
#include <string>

#include "artus/detail/training/records.h"
#include "artus/detail/viewer/words/translation.h"

namespace artus {

/// What people call a scenario's procedure; its name without underlines when it is not known.
[[nodiscard]] std::string procedure_words(Language language, const std::string& procedure);

/// A learner's logbook of competence, to be printed: by procedure what was done and passed, on how
/// many days, and when it is due again (make_logbook), with lines for what a supervisor signs.
/// `now`: UTC. Errors: not_found (no attempt of this person), those of the records and of
/// write_text.
[[nodiscard]] Result<void> write_logbook_page(Records& records, const std::string& person,
                                              const std::string& now, Language language,
                                              const std::filesystem::path& file);

}  // namespace artus
