// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/trainer/learn_flow.h"

#include <utility>

#include "artus/detail/trainer/review.h"

namespace artus {

void LearnFlow::begin() {
  content_.reset();
  expert_.reset();
  at_ = LearnChoice::looks;
}

Result<LearnFlow::After> LearnFlow::step(TrainTask& task) {
  const Language language = pages_->options().language;
  if (!content_) {
    auto made = pages_->meanwhile(msgid("The lesson is being prepared ..."),
                                  [&task, language]() -> Result<LearnContent> {
                                    return make_learn_content(task.scenario, task.scene, language);
                                  });
    ARTUS_TRY(made);
    if (!*made) return After::leave;
    content_ = std::move(**made);
  }
  const auto answer = pages_->show(make_learn_page(task.scenario, *content_, at_, language));
  ARTUS_TRY(answer);
  if (answer->kind == PageAnswer::Kind::back) return After::briefing;
  if (answer->kind != PageAnswer::Kind::chosen) return After::leave;
  const auto chosen = static_cast<LearnChoice>(answer->choice);
  if (chosen == LearnChoice::both) return After::briefing;
  at_ = static_cast<LearnChoice>(answer->choice + 1);
  return chosen < LearnChoice::expert ? After::again : with_expert(chosen, task);
}

Result<LearnFlow::After> LearnFlow::with_expert(LearnChoice chosen, TrainTask& task) {
  const char* const wait = msgid("The expert's run is being prepared ...");
  if (!expert_) {
    auto played = pages_->meanwhile(
        wait, [&task] { return play(task.scenario, task.scene, expert_skill(), {}); });
    ARTUS_TRY(played);
    if (!*played) return After::leave;
    expert_ = std::move((*played)->recording);
  }
  if (const auto led = led_in(chosen)) {
    task.scenario = for_one_hand(std::move(task.scenario));
    task.keys = pages_->options().keys;
    task.led = *led;
    task.way = way_of(*expert_, *led);
    return After::attempt;
  }
  auto review = pages_->meanwhile(wait, [&] {
    return make_run_review(task.scenario, task.scene, *expert_, pages_->options().language);
  });
  ARTUS_TRY(review);
  if (!*review) return After::leave;
  (*review)->of_expert = true;
  (*review)->outside = task.outside;
  pages_->leave_screen();
  const auto back = run_review(pages_->screen(), pages_->options(), **review);
  ARTUS_TRY(back);
  return *back ? After::again : After::leave;
}

}  // namespace artus
