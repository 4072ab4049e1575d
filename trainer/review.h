// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include "artus/detail/trainer/attempt.h"
#include "artus/detail/viewer/pages/review.h"

namespace artus {

/// A recording as it is looked at again: its ticks are replayed, 50 moments a second are kept, each
/// with the picture that was on the screen, or with that of its poses where none was recorded.
/// Errors: those of replay. Cost: that of its ticks.
[[nodiscard]] Result<ReviewFilm> make_film(const Recording& recording,
                                           const std::shared_ptr<const Scene>& scene);

/// An attempt with its faults, the truth behind its pictures and a simulated expert's run of the
/// same task. Errors: those of make_film and play.
[[nodiscard]] Result<Review> make_review(const TrainTask& task, const TrainOutcome& outcome,
                                         Language language);

/// A run alone, as a simulated expert's: picture, hands and forces, and what the truth says.
/// Errors: those of the replay. Cost: that of its ticks.
[[nodiscard]] Result<Review> make_run_review(const Scenario& scenario,
                                             const std::shared_ptr<const Scene>& scene,
                                             const Recording& recording, Language language);

}  // namespace artus
