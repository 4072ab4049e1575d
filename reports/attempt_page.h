// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <filesystem>
#include <memory>
#include <span>
#include <vector>

#include "artus/detail/training/feedback.h"
#include "artus/detail/training/player.h"
#include "artus/detail/training/records.h"
#include "artus/detail/viewer/words/translation.h"

namespace artus {

/// What the page of an attempt tells of; all outlives the call.
struct AttemptReport {
  const Scenario& scenario;
  const std::shared_ptr<const Scene>& scene;
  const PlayedAttempt& attempt;
  const Feedback& feedback;
  std::span<const Norm> norms;  ///< what experts do; may be empty
  Language language = Language::english;
};

/// Report of one attempt: verdict, faults with the picture of their moment, plots, numbers with
/// their definitions and what experts do. Static, needs nothing else. Errors: those of write_text.
[[nodiscard]] Result<void> write_attempt_page(const AttemptReport& report,
                                              const std::filesystem::path& file);

/// Report of a learner: the chart of one scenario with its chance of a false pass, what is believed
/// of the rate of failure, each attempt.
[[nodiscard]] Result<void> write_learner_page(Records& records, const std::string& person,
                                              Language language, const std::filesystem::path& file);

/// Report of a cohort: a line a learner, the spread of the metrics.
[[nodiscard]] Result<void> write_cohort_page(Records& records, const std::string& cohort,
                                             Language language, const std::filesystem::path& file);

}  // namespace artus
