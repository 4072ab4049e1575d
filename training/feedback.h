// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <span>
#include <string>
#include <vector>

#include "artus/detail/training/judgement.h"
#include "artus/detail/training/metrics/attempt_meter.h"

namespace artus {

/// One thing that went wrong, with what a learner needs to see it and to mend it.
struct Fault {
  std::string kind;   ///< "fatal:<name>", "left_in", "late", "unseen", "bone", "avoid:<name>",
                      ///< "drift", "passes", "off_target", "angle", "idle", "misplaced",
                      ///< "unaspirated", "pressure", "fast", "unasked", "never_in"
  double time = 0;    ///< s, of the moment to look at
  double weight = 0;  ///< severity of the kind times size beside its band, 0 to 3; half as much
                      ///< again for a fault of the attempt before, too
  std::string what;   ///< what was seen or felt, with its value and the band
  std::string cause;  ///< from the truth
  std::string mend;   ///< what to do
};

/// What harms is told before what misses the purpose, and that before style.
enum class FaultSeverity { style, purpose, harm, fatal };
[[nodiscard]] FaultSeverity severity_of_fault(const std::string& kind) noexcept;

/// What a learner is told after an attempt.
struct Feedback {
  std::string verdict;        ///< passed or not, and the mark that was missed
  std::vector<Fault> faults;  ///< three at most: harm first, then what misses the purpose, then
                              ///< style, each by weight; those of one cause are one
  std::string good;           ///< one thing done well; empty: there is none, or it harmed
  std::string next;           ///< one next task
  std::string next_scenario;  ///< its name among the bundled ones; empty: none is named
};

/// What hands and eyes can do, each trained by a task of its own; of two that
/// are as weak the earlier is trained first.
enum class Skill { look, view, align, steer, inject };
[[nodiscard]] Skill skill_of_fault(const std::string& kind) noexcept;

/// An attempt before this one.
struct PastAttempt {
  double weeks = 0;                ///< ago
  bool injected = false;           ///< liquid was given
  std::vector<std::string> kinds;  ///< of its faults
  bool looked = false;             ///< structures were to be shown, without needle
};
/// The same from an attempt's numbers, as records keep them.
[[nodiscard]] PastAttempt past_attempt(double weeks, std::span<const Metric> metrics);

/// What is known beside the attempt.
struct FeedbackContext {
  int level = 0;                    ///< of the scenario; idle times are told from 5 on
  std::vector<PastAttempt> before;  ///< oldest first
};

/// Bands are those of trained people where published, else assumed; they are told with each fault.
/// The next task is that of the weakest skill: the share of attempts without a fault of it, each
/// worth half as much after 20 weeks (assumed).
[[nodiscard]] Feedback make_feedback(const AttemptMeasures& measures, const Judgement& judgement,
                                     const FeedbackContext& context = {});

}  // namespace artus
