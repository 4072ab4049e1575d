// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <string>

#include <nlohmann/json.hpp>

#include "artus/detail/training/records.h"

namespace artus {

/// Attempts with all their metrics, ratings and comments, one object an attempt.
[[nodiscard]] Result<nlohmann::json> export_json(Records& records, const AttemptFilter& filter);
/// A line a metric of an attempt:
/// person,scenario,attempt,started,passed,score,metric,role,value,unit.
[[nodiscard]] Result<std::string> export_csv(Records& records, const AttemptFilter& filter);
/// The four columns of PerkTutor for one attempt or several in turn.
[[nodiscard]] Result<std::string> export_tsv(Records& records, const AttemptFilter& filter);
/// One xAPI statement a finished attempt: the actor an account with the pseudonym alone, the verb
/// passed or failed (attempted when aids were on), score 0 to 1, duration ISO 8601, metrics as
/// extensions. `home`: web address of who gave the pseudonyms. Errors: malformed, no address.
[[nodiscard]] Result<nlohmann::json> export_xapi(Records& records, const AttemptFilter& filter,
                                                 const std::string& home);

}  // namespace artus
