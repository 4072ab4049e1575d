// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "artus/training/judgement.h"
#include "artus/training/metrics/attempt_meter.h"

namespace artus {

/// One thing that went wrong, with what a learner needs to see it and to mend it.
struct Fault {
  std::string kind;  ///< "unseen", "bone", "avoid:<name>", "drift", "passes", "off_target", "angle"
  double time = 0;   ///< s, of the moment to look at
  double weight = 0;  ///< severity of the kind times size beside its band, 0 to 3
  std::string what;   ///< what was seen or felt, with its value and the band
  std::string cause;  ///< from the truth
  std::string mend;   ///< what to do
};

/// What a learner is told after an attempt.
struct Feedback {
  std::string verdict;        ///< passed or not, and the mark that was missed
  std::vector<Fault> faults;  ///< three at most, worst first; those of one cause are one
  std::string good;           ///< one thing done well; may be empty
  std::string next;           ///< one next task
};

/// Bands are those of trained people where published, else assumed; they are told with each fault.
[[nodiscard]] Feedback make_feedback(const AttemptMeasures& measures, const Judgement& judgement);

}  // namespace artus
