// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <optional>

#include "artus/detail/trainer/learn.h"
#include "artus/detail/trainer/page_show.h"

namespace artus {

/// The lesson of a task, step by step: what is told on its page, the expert's run, and who has one
/// hand alone.
class LearnFlow {
 public:
  explicit LearnFlow(PageShow& pages) : pages_(&pages) {}

  /// The lesson of this task from its first step on.
  void begin();

  enum class After { again, briefing, attempt, leave };
  /// One step; `task`: whose scenario and scene it is, and with attempt the task that is to be
  /// made. Errors: those of PageShow, play and the review.
  [[nodiscard]] Result<After> step(TrainTask& task);

 private:
  [[nodiscard]] Result<After> with_expert(LearnChoice chosen, TrainTask& task);

  PageShow* pages_;
  std::optional<LearnContent> content_;
  std::optional<Recording> expert_;
  LearnChoice at_ = LearnChoice::looks;
};

}  // namespace artus
