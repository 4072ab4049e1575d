// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <optional>
#include <string>

#include "artus/detail/training/judgement.h"
#include "artus/detail/training/scenario.h"
#include "artus/detail/viewer/words/strings.h"

namespace artus {

/// What the pages of `artus train` say, one row of the table in train_texts.cpp each.
enum class Said {
  who_title,
  who_text,
  who_new,
  who_about,
  new_title,
  new_text,
  new_go_on,
  what_title,
  level_is,
  what_done,
  what_passed,
  what_new,
  what_time,
  what_instruments,
  what_probe,
  what_syringe,
  what_earlier,
  busy_earlier,
  brief_target_point,
  brief_left,
  brief_right,
  brief_middle,
  brief_target_in,
  brief_find,
  find_now,
  find_done,
  brief_judged,
  brief_entry,
  brief_entry_far,
  brief_view,
  brief_hands_title,
  brief_probe,
  brief_needle,
  brief_plunger,
  brief_done,
  brief_found,
  brief_begin,
  brief_begin_aided,
  brief_without_aids,
  brief_aided_note,
  ask_side,
  ask_allergy,
  ask_consent,
  answer_left,
  answer_right,
  answer_no_side,
  answer_allergy,
  answer_consent,
  asked,
  step_ask_side,
  step_ask_allergy,
  step_ask_consent,
  step_entry,
  step_tip_seen,
  step_placed,
  step_injected,
  step_withdrawn,
  clock,
  patient_gel,
  patient_calm,
  patient_prick,
  patient_bone,
  patient_nerve,
  patient_pain,
  patient_long,
  busy_body,
  busy_numbers,
  end_passed,
  end_not_passed,
  end_aided,
  end_score,
  end_marks,
  end_held,
  end_missed,
  end_unknown,
  end_faults,
  end_well,
  end_report,
  end_review,
  end_again,
  end_next,
  end_other,
  end_who,
  end_leave,
  colon,
  relation_at_most,
  relation_less,
  relation_equal,
  relation_at_least,
  relation_more,
  sight_where,
  sight_seen,
  sight_no_contact,
  sight_off_plane,
  sight_off_sector,
  sight_shadow,
  sight_angle,
  busy_review,
  n_said
};

[[nodiscard]] const char* said(Language language, Said which) noexcept;
/// A metric in words, with its unit; its name where the table has none.
[[nodiscard]] std::string metric_words(Language language, const std::string& metric);
/// What a mark asks for: "at most 2".
[[nodiscard]] std::string bound_words(Language language, const Mark& mark);
/// "tip from the target, mm: at most 2".
[[nodiscard]] std::string mark_words(Language language, const Mark& mark);
/// A scenario's title; the English one where it has none in the language.
[[nodiscard]] const std::string& title_words(Language language, const Scenario& scenario);
/// A step of a scenario in words.
[[nodiscard]] std::string step_words(Language language, const std::string& step);

}  // namespace artus
