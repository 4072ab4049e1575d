// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "artus/detail/training/feedback.h"
#include "artus/detail/training/player.h"
#include "artus/detail/training/records.h"

namespace artus {

/// What someone did, in all or of one scenario.
struct TrainTally {
  int attempts = 0;  ///< that were finished
  int passes = 0;
  int successes = 0;  ///< that held all marks, with aids or without
  double best = 0;    ///< score
  std::string last;   ///< UTC, when the last began; empty: never
};

/// Who trains here and what they did: the records behind the pages of `artus train`.
class TrainDesk {
 public:
  /// `attempts`: where their folders go. Errors: those of Records::open.
  [[nodiscard]] static Result<TrainDesk> open(const std::filesystem::path& records,
                                              std::filesystem::path attempts);

  [[nodiscard]] Result<std::vector<std::string>> learners();
  /// A pseudonym that nobody has, and who gets it is known from now on.
  [[nodiscard]] Result<std::string> add_learner(const std::string& cohort);
  /// `scenario`: empty: all.
  [[nodiscard]] Result<TrainTally> tally(const std::string& person, const std::string& scenario);

  /// What someone finished and can look at again, the latest first: their recordings are there.
  [[nodiscard]] Result<std::vector<AttemptRecord>> finished(const std::string& person);
  /// What the same person had done when an attempt began.
  [[nodiscard]] Result<std::vector<PastAttempt>> before(const AttemptRecord& attempt);
  /// What happened in an attempt, as it was stored.
  [[nodiscard]] Result<std::vector<AttemptEvent>> events(const AttemptRecord& attempt);
  /// What experts do in the attempt's scenario.
  [[nodiscard]] Result<std::vector<Norm>> norms(const AttemptRecord& attempt);

  /// Notes that an attempt begins and makes its folder; `aided`: with aids. Errors: unreadable.
  [[nodiscard]] Result<AttemptRecord> begin(const std::string& person, const Scenario& scenario,
                                            const std::string& device);
  /// Notes how it ended.
  [[nodiscard]] Result<void> finish(AttemptRecord attempt, const PlayedAttempt& played);

 private:
  TrainDesk(Records records, std::filesystem::path attempts)
      : records_(std::move(records)), attempts_(std::move(attempts)) {}
  Records records_;
  std::filesystem::path attempts_;
};

/// A scenario as someone with so many successes gets it: its aids fainter, or off when they are not
/// `wanted`.
[[nodiscard]] Scenario with_faded_aids(Scenario scenario, const TrainTally& tally, bool wanted);

}  // namespace artus
