// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/trainer/train_pages.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "artus/detail/core/units.h"
#include "artus/detail/reports/feedback_words.h"
#include "artus/detail/trainer/train_lesson.h"
#include "artus/detail/viewer/words/anatomy_names.h"

namespace artus {
namespace {

std::string tally_words(Language language, const TrainTally& tally) {
  return fill(said(language, Said::what_done),
              {std::to_string(tally.attempts), std::to_string(tally.passes),
               std::to_string(whole_points(tally.best))});
}

/// What is asked of an attempt, a line a mark.
void add_marks(const Scenario& scenario, Language language, std::vector<PageLine>& lines) {
  lines.push_back({said(language, Said::brief_judged), Tone::heading});
  for (const Mark& mark : scenario.pass) lines.push_back({mark_words(language, mark)});
}

std::string instrument_words(const Scenario& scenario, Language language) {
  if (!scenario.find.empty()) return fill(said(language, Said::what_probe), {scenario.transducer});
  return fill(said(language, Said::what_instruments),
              {scenario.transducer, std::to_string(scenario.gauge),
               number(language, scenario.needle_length / kMillimetre, 0)});
}

/// What is to be given, when something is.
void add_syringe(const Scenario& scenario, Language language, std::vector<PageLine>& lines) {
  const ScenarioSyringe& syringe = scenario.syringe;
  if (syringe.volume <= 0) return;
  lines.push_back({fill(said(language, Said::what_syringe),
                        {number(language, syringe.volume / kCubicCentimetre, 1),
                         clinical_name(language, syringe.liquid),
                         number(language, syringe.rate / kCubicCentimetre, 2)})});
}

std::vector<PageLine> about_task(const OfferedTask& task, Language language) {
  const Scenario& scenario = task.scenario;
  std::vector<PageLine> lines{{goal_words(scenario, language)}};
  add_syringe(scenario, language, lines);
  lines.push_back(
      {fill(said(language, Said::what_time), {number(language, scenario.time_limit, 0)})});
  if (task.tally.attempts > 0) lines.push_back({tally_words(language, task.tally), Tone::dim});
  add_marks(scenario, language, lines);
  return lines;
}

struct Question {
  const char* step;
  Said asked;
};
constexpr std::array<Question, 3> kQuestions{{{"ask:side", Said::ask_side},
                                              {"ask:allergy", Said::ask_allergy},
                                              {"ask:consent", Said::ask_consent}}};

const Question* find_question(const std::string& step) {
  for (const Question& question : kQuestions)
    if (step == question.step) return &question;
  return nullptr;
}

Said answer_to(const std::string& step, const std::string& side) {
  if (step == "ask:allergy") return Said::answer_allergy;
  if (step == "ask:consent") return Said::answer_consent;
  if (side == "left") return Said::answer_left;
  return side == "right" ? Said::answer_right : Said::answer_no_side;
}

/// How mouse and keys move the hands.
void add_hands(const Scenario& scenario, const KeyMap& keys, Language language,
               std::vector<PageLine>& lines) {
  const auto key = [&](Action action) {
    return keys.said_key(action, language);
  };
  lines.push_back({said(language, Said::brief_hands_title), Tone::heading});
  const bool needle = scenario.find.empty();
  if (needle)
    lines.push_back({fill(said(language, Said::brief_needle),
                          {key(Action::take_needle), key(Action::push), key(Action::pull)})});
  lines.push_back({fill(said(language, Said::brief_probe), {key(Action::take_probe)})});
  if (scenario.syringe.volume > 0)
    lines.push_back({fill(said(language, Said::brief_plunger), {key(Action::take_plunger)})});
  lines.push_back(
      {fill(said(language, needle ? Said::brief_done : Said::brief_found), {key(Action::finish)})});
}

void add_verdict(const TrainOutcome& outcome, Language language, std::vector<PageLine>& lines) {
  const Judgement& judgement = outcome.played.judgement;
  lines.push_back(
      {fill(said(language, Said::end_score), {std::to_string(whole_points(judgement.score)),
                                              number(language, outcome.played.duration, 0)})});
  lines.push_back({said(language, Said::end_marks), Tone::heading});
  for (const JudgedMark& mark : judgement.marks) {
    const std::string value =
        mark.value ? number(language, *mark.value, *mark.value == std::round(*mark.value) ? 0 : 2)
                   : said(language, Said::end_unknown);
    lines.push_back({fill(said(language, Said::colon),
                          {metric_words(language, mark.mark.metric),
                           value + " (" + bound_words(language, mark.mark) + "), " +
                               said(language, mark.held ? Said::end_held : Said::end_missed)}),
                     mark.held ? Tone::good : Tone::bad});
  }
}

}  // namespace

Page make_who_page(const std::vector<KnownLearner>& learners, Language language) {
  Page page;
  page.stage = "who";
  page.title = said(language, Said::who_title);
  page.lines = {{said(language, Said::who_text), Tone::dim}};
  for (const KnownLearner& learner : learners) {
    const TrainTally& tally = learner.tally;
    page.choices.push_back({learner.name,
                            std::to_string(tally.passes) + "/" + std::to_string(tally.attempts),
                            Tone::plain,
                            {{fill(said(language, Said::who_about),
                                   {std::to_string(tally.attempts), std::to_string(tally.passes),
                                    tally.last.empty() ? "-" : tally.last})}},
                            nullptr});
  }
  page.choices.push_back({said(language, Said::who_new), "", Tone::good, {}, nullptr});
  return page;
}

Page make_welcome_page(const std::string& person, Language language) {
  Page page;
  page.stage = "pseudonym";
  page.title = fill(said(language, Said::new_title), {person});
  page.lines = {{said(language, Said::new_text)}};
  page.choices = {{said(language, Said::new_go_on), "", Tone::good, {}, nullptr}};
  return page;
}

Page make_what_page(const std::vector<OfferedTask>& tasks, const std::string& person,
                    TrainBodies& bodies, std::size_t at, Language language) {
  Page page;
  page.stage = "what";
  page.title = fill(said(language, Said::what_title), {person});
  page.may_back = true;
  page.at = at;
  for (const OfferedTask& task : tasks) {
    const bool passed = task.tally.passes > 0;
    const std::string state = passed ? said(language, Said::what_passed)
                              : task.tally.attempts > 0
                                  ? std::to_string(whole_points(task.tally.best))
                                  : said(language, Said::what_new);
    page.choices.push_back(
        {title_words(language, task.scenario),
         fill(said(language, Said::level_is), {std::to_string(task.scenario.level)}) + "   " +
             state,
         passed ? Tone::good : Tone::plain, about_task(task, language), nullptr});
  }
  if (std::any_of(tasks.begin(), tasks.end(),
                  [](const OfferedTask& task) { return task.tally.attempts > 0; }))
    page.choices.push_back({said(language, Said::what_earlier), "", Tone::heading, {}, nullptr});
  page.refresh = [&tasks, &bodies](Page& shown) {
    if (shown.at >= tasks.size()) return;
    bodies.want(tasks[shown.at].scenario);
    shown.choices[shown.at].picture = bodies.picture(tasks[shown.at].scenario);
  };
  return page;
}

Page make_earlier_page(const std::vector<EarlierAttempt>& attempts, Language language) {
  Page page;
  page.stage = "earlier";
  page.title = said(language, Said::what_earlier);
  page.may_back = true;
  for (const auto& [record, title] : attempts) {
    const Said how = record.passed  ? Said::end_passed
                     : record.aided ? Said::end_aided
                                    : Said::end_not_passed;
    std::string when = record.started;
    std::replace(when.begin(), when.end(), 'T', ' ');
    page.choices.push_back(
        {title,
         when,
         record.passed ? Tone::good : Tone::plain,
         {{said(language, how)},
          {fill(said(language, Said::end_score), {std::to_string(whole_points(record.score)),
                                                  number(language, record.duration, 0)})}},
         nullptr});
  }
  return page;
}

std::vector<BriefingChoice> briefing_choices(const Scenario& scenario) {
  std::vector<BriefingChoice> choices;
  for (const std::string& step : scenario.steps)
    if (find_question(step) != nullptr) choices.push_back({BriefingChoice::Kind::ask, step});
  if (scenario.aided()) choices.push_back({BriefingChoice::Kind::begin_aided, ""});
  choices.push_back({BriefingChoice::Kind::begin, ""});
  return choices;
}

Page make_briefing_page(const Scenario& scenario, const std::set<std::string>& asked,
                        const std::string& side, const std::shared_ptr<const PagePicture>& picture,
                        const KeyMap& keys, Language language) {
  Page page;
  page.stage = "briefing";
  page.title = title_words(language, scenario);
  page.may_back = true;
  page.lines = {{goal_words(scenario, language)}};
  const Vec3 entry_P = scenario.X_JP.inverse() * scenario.entry.centre;
  if (scenario.find.empty() && scenario.entry.plane == "in")
    page.lines.push_back(
        {said(language, entry_P.x() < 0 ? Said::brief_entry : Said::brief_entry_far)});
  page.lines.push_back({instrument_words(scenario, language)});
  add_syringe(scenario, language, page.lines);
  page.lines.push_back(
      {fill(said(language, Said::what_time), {number(language, scenario.time_limit, 0)})});
  add_hands(scenario, keys, language, page.lines);
  if (scenario.aided()) page.lines.push_back({said(language, Said::brief_aided_note), Tone::dim});
  std::vector<PageLine> about;
  if (scenario.find.empty()) about.push_back({said(language, Said::brief_view), Tone::dim});
  add_marks(scenario, language, about);
  for (const BriefingChoice& choice : briefing_choices(scenario)) {
    std::string name =
        said(language, scenario.aided() ? Said::brief_without_aids : Said::brief_begin);
    std::string beside;
    if (choice.kind == BriefingChoice::Kind::begin_aided)
      name = said(language, Said::brief_begin_aided);
    if (const Question* question = find_question(choice.step)) {
      const bool answered = asked.count(choice.step) != 0;
      name = said(language, question->asked);
      if (answered) beside = said(language, answer_to(choice.step, side));
    }
    const bool question = choice.kind == BriefingChoice::Kind::ask;
    page.choices.push_back({name, beside, question ? Tone::plain : Tone::good, about, picture});
  }
  return page;
}

Page make_end_page(const TrainOutcome& outcome, const std::string& next, Language language) {
  const Judgement& judgement = outcome.played.judgement;
  const Feedback& feedback = outcome.feedback;
  const auto in_words = [language](const std::string& line) {
    return feedback_words(language, line);
  };
  Page page;
  page.stage = "end";
  const bool all_held = std::all_of(judgement.marks.begin(), judgement.marks.end(),
                                    [](const JudgedMark& mark) { return mark.held; });
  page.title = said(language, judgement.passed                  ? Said::end_passed
                              : all_held && judgement.with_aids ? Said::end_aided
                                                                : Said::end_not_passed);
  add_verdict(outcome, language, page.lines);
  page.lines.push_back(
      {fill(said(language, Said::end_report), {outcome.report.string()}), Tone::dim});
  std::vector<PageLine> about;
  if (!feedback.faults.empty()) about.push_back({said(language, Said::end_faults), Tone::heading});
  for (const Fault& fault : feedback.faults) {
    about.push_back({fill(said(language, Said::colon),
                          {number(language, fault.time, 1) + " s", in_words(fault.what)}),
                     Tone::bad});
    about.push_back({fill(text(language, Text::review_cause), {in_words(fault.cause)})});
    about.push_back({fill(text(language, Text::review_do), {in_words(fault.mend)}), Tone::good});
  }
  if (!feedback.good.empty())
    about.push_back({fill(said(language, Said::end_well), {in_words(feedback.good)}), Tone::good});
  about.push_back({in_words(feedback.next)});
  for (const Said choice : {Said::end_review, Said::end_again, Said::end_next, Said::end_other,
                            Said::end_who, Said::end_leave})
    page.choices.push_back(
        {choice == Said::end_next ? fill(said(language, choice), {next}) : said(language, choice),
         "", Tone::plain, about, nullptr});
  return page;
}

Page make_busy_page(Said what, std::function<bool()> done, Language language) {
  Page page;
  page.title = said(language, what);
  page.done = std::move(done);
  return page;
}

}  // namespace artus
