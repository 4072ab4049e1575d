// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/reports/logbook_page.h"

#include <algorithm>
#include <array>
#include <vector>

#include "artus/detail/core/text_file.h"
#include "artus/detail/reports/html_page.h"
#include "artus/detail/reports/mark_words.h"
#include "artus/detail/training/logbook.h"

namespace artus {
namespace {

struct NamedProcedure {
  const char* name;
  const char* words;
};
constexpr std::array<NamedProcedure, 16> kProcedures{{
    {"", msgid("Basics on a gel block")},
    {"sasd_lateral", msgid("Subacromial bursa from lateral")},
    {"sasd_anterior", msgid("Subacromial bursa from in front")},
    {"gh_posterior", msgid("Shoulder joint from behind")},
    {"lhb_sheath", msgid("Sheath of the long biceps tendon")},
    {"gh_interval", msgid("Shoulder joint through the rotator interval")},
    {"ac", msgid("Acromioclavicular joint")},
    {"gh_distension", msgid("Distension of the shoulder joint")},
    {"ssn_notch", msgid("Suprascapular nerve at the notch")},
    {"barbotage", msgid("Barbotage of a calcific deposit")},
    {"common_extensor", msgid("Common extensor tendon at the elbow")},
    {"elbow_posterior", msgid("Elbow joint from behind")},
    {"carpal_tunnel", msgid("Carpal tunnel")},
    {"first_compartment", msgid("First extensor compartment")},
    {"tibiotalar", msgid("Ankle joint from in front")},
    {"retrocalcaneal", msgid("Retrocalcaneal bursa")},
}};

constexpr std::size_t kDay = 10;  // characters of a date

std::string day_of(const std::string& utc) {
  return utc.empty() ? "-" : utc.substr(0, kDay);
}

std::string state_words(const HtmlPage& page, LogbookState state) {
  switch (state) {
    case LogbookState::none:
      return translate(page, "not begun");
    case LogbookState::training:
      return translate(page, "in training");
    case LogbookState::held:
      return translate(page, "passed");
    case LogbookState::due:
      return translate(page, "due again");
  }
  return "";
}

/// What was done of all tasks of a procedure.
LogbookTask sum_of(const std::vector<LogbookTask>& tasks) {
  LogbookTask sum;
  bool all_held = true;
  bool any_due = false;
  for (const LogbookTask& task : tasks) {
    sum.attempts += task.attempts;
    sum.unaided += task.unaided;
    sum.passed += task.passed;
    sum.last_pass = std::max(sum.last_pass, task.last_pass);
    if (!task.due.empty() && (sum.due.empty() || task.due < sum.due)) sum.due = task.due;
    all_held = all_held && task.state == LogbookState::held;
    any_due = any_due || task.state == LogbookState::due;
  }
  if (sum.attempts > 0) sum.state = LogbookState::training;
  if (all_held) sum.state = LogbookState::held;
  if (any_due) sum.state = LogbookState::due;
  return sum;
}

std::vector<std::string> row_of(const HtmlPage& page, const std::string& name,
                                const LogbookTask& task) {
  return {name,
          std::to_string(task.attempts),
          std::to_string(task.unaided),
          std::to_string(task.passed),
          day_of(task.first_pass),
          day_of(task.last_pass),
          day_of(task.due),
          state_words(page, task.state)};
}

std::vector<HtmlPage::Column> columns_of(const HtmlPage& page, const char* first) {
  return {{translate(page, first), "", true},
          {translate(page, "attempts"), translate(page, "finished ones")},
          {translate(page, "without aids"), translate(page, "only they can be passed")},
          {translate(page, "passed"), ""},
          {translate(page, "first passed"), ""},
          {translate(page, "last passed"), ""},
          {translate(page, "due"),
           translate(page,
                     "4 weeks after the first day on which it was passed, twice as long "
                     "after each further day, 26 weeks at most (assumed)")},
          {translate(page, "state"), ""}};
}

/// Lines that a supervisor fills in by hand.
void add_supervision(HtmlPage& page) {
  constexpr std::size_t kLines = 6;
  page.heading(translate(page, "Supervised, in patients"));
  page.paragraph(translate(page,
                           "To be filled in by hand: what a simulator counts is no supervised "
                           "procedure, and no certificate."));
  const std::vector<std::string> empty{"", "", "", "", ""};
  page.table({{translate(page, "date"), ""},
              {translate(page, "procedure"), ""},
              {translate(page, "side"), ""},
              {translate(page, "supervised by"), ""},
              {translate(page, "signature"), ""}},
             std::vector<std::vector<std::string>>(kLines, empty));
}

}  // namespace

std::string procedure_words(Language language, const std::string& procedure) {
  for (const NamedProcedure& known : kProcedures)
    if (procedure == known.name) return translate(language, known.words);
  std::string plain = procedure;
  std::replace(plain.begin(), plain.end(), '_', ' ');
  return plain;
}

Result<void> write_logbook_page(Records& records, const std::string& person, const std::string& now,
                                Language language, const std::filesystem::path& file) {
  const auto attempts = records.attempts({person, "", ""});
  ARTUS_TRY(attempts);
  if (attempts->empty())
    return fail(ErrorCode::not_found, "there is no attempt of this person", person);
  std::vector<Scenario> scenarios;
  for (const std::string_view text : bundled_scenario_texts())
    if (auto scenario = parse_scenario(text, "bundled")) scenarios.push_back(std::move(*scenario));
  const std::vector<LogbookTask> book = make_logbook(scenarios, *attempts, now);
  HtmlPage page(fill(translate(language, "Logbook of {}"), {person}), language);
  page.paragraph(fill(translate(page, "On {}: simulated patients alone."), {day_of(now)}));
  std::vector<std::vector<std::string>> procedures;
  std::vector<std::vector<std::string>> tasks;
  for (const NamedProcedure& known : kProcedures) {
    std::vector<LogbookTask> own;
    for (std::size_t i = 0; i < book.size(); ++i) {
      if (book[i].procedure != known.name) continue;
      own.push_back(book[i]);
      tasks.push_back(row_of(page, title_words(language, scenarios[i]), book[i]));
    }
    procedures.push_back(row_of(page, translate(page, known.words), sum_of(own)));
  }
  page.heading(translate(page, "By procedure"));
  page.table(columns_of(page, msgid("procedure")), procedures);
  page.heading(translate(page, "By task"));
  page.table(columns_of(page, msgid("task")), tasks);
  add_supervision(page);
  return write_text(file, page.text());
}

}  // namespace artus
