// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/trainer/pages.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <iomanip>
#include <sstream>
#include <utility>

#include "artus/detail/core/units.h"
#include "artus/detail/reports/feedback_words.h"
#include "artus/detail/reports/mark_words.h"
#include "artus/detail/trainer/lesson.h"
#include "artus/detail/viewer/words/anatomy_names.h"
#include "artus/detail/viewer/words/system_words.h"

namespace artus {
namespace {

std::string tally_words(Language language, const TrainTally& tally) {
  return fill(translate_count(language, "{} attempt, {} passed; best score {}",
                              "{} attempts, {} passed; best score {}", tally.attempts),
              {std::to_string(tally.attempts), std::to_string(tally.passes),
               std::to_string(whole_points(tally.best))});
}

/// What is asked of an attempt, a line a mark.
void add_marks(const Scenario& scenario, Language language, std::vector<PageLine>& lines) {
  lines.push_back({translate(language, "What is judged"), Tone::heading});
  for (const Mark& mark : scenario.pass) lines.push_back({mark_words(language, mark)});
}

std::string instrument_words(const Scenario& scenario, Language language) {
  if (!scenario.find.empty()) return fill(translate(language, "Probe {}"), {scenario.transducer});
  return fill(translate(language, "Probe {}, needle {} G of {} mm"),
              {scenario.transducer, std::to_string(scenario.gauge),
               number(language, scenario.needle_length / kMillimetre, 0)});
}

/// What is to be given, when something is.
void add_syringe(const Scenario& scenario, Language language, std::vector<PageLine>& lines) {
  const ScenarioSyringe& syringe = scenario.syringe;
  if (syringe.volume <= 0) return;
  lines.push_back({fill(translate(language, "Aspirate first, then inject {} ml of {} at {} ml/s"),
                        {number(language, syringe.volume / kCubicCentimetre, 1),
                         clinical_name(language, syringe.liquid),
                         number(language, syringe.rate / kCubicCentimetre, 2)})});
}

std::vector<PageLine> about_task(const OfferedTask& task, Language language) {
  const Scenario& scenario = task.scenario;
  std::vector<PageLine> lines{{goal_words(scenario, language)}};
  add_syringe(scenario, language, lines);
  lines.push_back(
      {fill(translate(language, "Time: {} s"), {number(language, scenario.time_limit, 0)})});
  if (!task.open)
    lines.push_back({fill(translate(language, "level {}"), {std::to_string(scenario.level)}) +
                         ", " + translate(language, "locked"),
                     Tone::dim});
  if (task.tally.attempts > 0) lines.push_back({tally_words(language, task.tally), Tone::dim});
  return lines;
}

struct Question {
  const char* step;
  const char* asked;
};
constexpr std::array<Question, 5> kQuestions{
    {{"ask:side", msgid("Ask: which side is it?")},
     {"ask:allergy", msgid("Ask: any allergies?")},
     {"ask:consent", msgid("Ask: do you agree to it?")},
     {"ask:anticoagulation", msgid("Ask: do you take blood thinners?")},
     {"ask:infection", msgid("Ask: fever, or an infection of the skin?")}}};

const Question* find_question(const std::string& step) {
  for (const Question& question : kQuestions)
    if (step == question.step) return &question;
  return nullptr;
}

const char* answer_to(const std::string& step, const std::string& side) {
  if (step == "ask:allergy") return msgid("None that I know of.");
  if (step == "ask:anticoagulation") return msgid("No, none.");
  if (step == "ask:infection") return msgid("No, nothing of that kind.");
  if (step == "ask:consent") return msgid("Yes, go ahead.");
  if (side == "left") return msgid("The left one, please.");
  return side == "right" ? msgid("The right one, please.") : msgid("This one.");
}

/// How mouse and keys move the hands.
void add_hands(const Scenario& scenario, const KeyMap& keys, Language language,
               std::vector<PageLine>& lines) {
  const auto key = [&](Action action) {
    return keys.said_key(action, language);
  };
  lines.push_back({translate(language, "Your hands"), Tone::heading});
  const bool needle = scenario.find.empty();
  if (needle)
    lines.push_back({fill(
        translate(
            language,
            "{} takes the needle: the mouse moves and turns it, wheel or {} pushes, {} pulls"),
        {key(Action::take_needle), key(Action::push), key(Action::pull)})});
  lines.push_back(
      {fill(translate(language, "{} takes the probe: the mouse slides it, the wheel turns it"),
            {key(Action::take_probe)})});
  if (scenario.syringe.volume > 0)
    lines.push_back(
        {fill(translate(language, "{} puts the thumb on the plunger: the wheel then presses it"),
              {key(Action::take_plunger)})});
  lines.push_back(
      {fill(translate(language,
                      needle ? msgid("{} when the needle is out again: the attempt is then judged")
                             : msgid("The attempt ends when all are shown, or with {}")),
            {key(Action::finish)})});
}

void add_verdict(const TrainOutcome& outcome, Language language, std::vector<PageLine>& lines) {
  const Judgement& judgement = outcome.played.judgement;
  lines.push_back({fill(translate(language, "Score {} of 100, {} s"),
                        {std::to_string(whole_points(judgement.score)),
                         number(language, outcome.played.duration, 0)})});
  lines.push_back({translate(language, "Marks"), Tone::heading});
  for (const JudgedMark& mark : judgement.marks) {
    const std::string value =
        mark.value ? number(language, *mark.value, *mark.value == std::round(*mark.value) ? 0 : 2)
                   : translate(language, "not known");
    lines.push_back({fill(translate(language, "{}: {}"),
                          {metric_words(language, mark.mark.metric),
                           value + " (" + bound_words(language, mark.mark) + "), " +
                               translate(language, mark.held ? msgid("met") : msgid("missed"))}),
                     mark.held ? Tone::good : Tone::bad});
  }
  if (outcome.record.device == kPaperHands)
    lines.push_back({translate(language,
                               "Your hands felt no force of the simulation: force, pressure and "
                               "how hard bone was met are not judged"),
                     Tone::dim});
  for (const Mark& mark : judgement.unjudged)
    lines.push_back(
        {fill(translate(language, "{}: not judged"), {metric_words(language, mark.metric)}),
         Tone::dim});
}

/// "2026-01-31 13:00" by this machine's clock of "2026-01-31T12:00:00Z".
std::string local_time(const std::string& utc) {
  std::tm parts{};
  std::istringstream text(utc);
  text >> std::get_time(&parts, "%Y-%m-%dT%H:%M:%SZ");
  if (text.fail()) return utc;
  const std::time_t time = timegm(&parts);
  std::tm here{};
  localtime_r(&time, &here);
  std::ostringstream out;
  out << std::put_time(&here, "%Y-%m-%d %H:%M");
  return out.str();
}

/// What was left out of the numbers, so that nobody wonders.
void add_left_out(const AttemptMeasures& measures, Language language,
                  std::vector<PageLine>& lines) {
  const auto poses = static_cast<long>(measures.needle_left_out + measures.probe_left_out);
  if (poses == 0) return;
  lines.push_back({fill(translate_count(language,
                                        "{} pose was left out: no hand moves so fast. A tracker "
                                        "that flips its marker does this.",
                                        "{} poses were left out: no hand moves so fast. A tracker "
                                        "that flips its marker does this.",
                                        poses),
                        {std::to_string(poses)}),
                   Tone::dim});
}

}  // namespace

Page make_who_page(const std::vector<KnownLearner>& learners, Language language) {
  Page page;
  page.name = "who";
  page.title = translate(language, "Who is training?");
  page.lines = {{translate(language, "Records keep nothing but a pseudonym."), Tone::dim}};
  for (const KnownLearner& learner : learners) {
    const TrainTally& tally = learner.tally;
    page.choices.push_back(
        {learner.name,
         std::to_string(tally.passes) + "/" + std::to_string(tally.attempts),
         Tone::plain,
         {{fill(translate_count(language, "{} attempt, {} passed; last: {}",
                                "{} attempts, {} passed; last: {}", tally.attempts),
                {std::to_string(tally.attempts), std::to_string(tally.passes),
                 tally.last.empty() ? "-" : local_time(tally.last)})}},
         nullptr});
  }
  page.choices.push_back({translate(language, "Someone new"), "", Tone::good, {}, nullptr});
  return page;
}

Page make_welcome_page(const std::string& person, Language language) {
  Page page;
  page.name = "pseudonym";
  page.title = fill(translate(language, "Your pseudonym is {}"), {person});
  page.lines = {{translate(
      language,
      "Write it down: you need it to find your attempts again. Nothing else about you is kept.")}};
  page.choices = {{translate(language, "Continue"), "", Tone::good, {}, nullptr}};
  return page;
}

void unlock_levels(std::vector<OfferedTask>& tasks) {
  const auto passed = [&tasks](int level) {
    return std::any_of(tasks.begin(), tasks.end(), [level](const OfferedTask& task) {
      return task.scenario.level == level && task.tally.passes > 0;
    });
  };
  for (OfferedTask& task : tasks) {
    int before = -1;  // the level before this one's
    for (const OfferedTask& other : tasks)
      if (other.scenario.level < task.scenario.level)
        before = std::max(before, other.scenario.level);
    bool higher = false;  // who passed a higher one needs no lower one
    for (const OfferedTask& other : tasks)
      higher = higher || (other.scenario.level >= task.scenario.level && other.tally.passes > 0);
    task.open = before < 0 || passed(before) || higher || task.tally.attempts > 0;
  }
}

std::size_t opener_of(const std::vector<OfferedTask>& tasks, std::size_t locked) {
  std::size_t opener = 0;
  for (std::size_t i = 0; i < tasks.size(); ++i)
    if (tasks[i].scenario.level < tasks[locked].scenario.level && tasks[i].open &&
        (tasks[i].scenario.level > tasks[opener].scenario.level ||
         (tasks[i].scenario.level == tasks[opener].scenario.level &&
          tasks[opener].tally.passes > 0)))
      opener = i;
  return opener;
}

Page make_what_page(const std::vector<OfferedTask>& tasks, const std::string& person,
                    TrainBodies& bodies, std::size_t at, Language language) {
  Page page;
  page.name = "what";
  page.title = fill(translate(language, "What do you want to do, {}?"), {person});
  page.may_back = true;
  page.at = at;
  for (const OfferedTask& task : tasks) {
    const bool passed = task.tally.passes > 0;
    const std::string state = passed ? translate(language, "passed")
                              : task.tally.attempts > 0
                                  ? std::to_string(whole_points(task.tally.best))
                                  : translate(language, "new");
    page.choices.push_back(
        {title_words(language, task.scenario),
         task.open ? fill(translate(language, "level {}"), {std::to_string(task.scenario.level)}) +
                         "   " + state
                   : "",
         !task.open ? Tone::dim
         : passed   ? Tone::good
                    : Tone::plain,
         about_task(task, language), nullptr});
  }
  if (std::any_of(tasks.begin(), tasks.end(),
                  [](const OfferedTask& task) { return task.tally.attempts > 0; }))
    page.choices.push_back(
        {translate(language, "Review an earlier attempt"), "", Tone::heading, {}, nullptr});
  page.refresh = [&tasks, &bodies](Page& shown) {
    if (shown.at >= tasks.size()) return;
    bodies.want(tasks[shown.at].scenario);
    shown.choices[shown.at].picture = bodies.picture(tasks[shown.at].scenario);
  };
  return page;
}

Page make_locked_page(const Scenario& locked, const Scenario& opener, Language language) {
  Page page;
  page.name = "locked";
  page.title = title_words(language, locked);
  page.may_back = true;
  page.lines = {
      {fill(translate(
                language,
                "Level {} is locked: levels open one after the other, and you are at level {}."),
            {std::to_string(locked.level), std::to_string(opener.level)})},
      {translate(language, "What comes before is what this one builds on."), Tone::dim}};
  page.choices = {
      {fill(translate(language, "To your next task: {}"), {title_words(language, opener)}),
       "",
       Tone::good,
       {},
       nullptr},
      {translate(language, "Begin it all the same: a teacher says so"),
       "",
       Tone::plain,
       {},
       nullptr}};
  return page;
}

Page make_earlier_page(const std::vector<EarlierAttempt>& attempts, Language language) {
  Page page;
  page.name = "earlier";
  page.title = translate(language, "Review an earlier attempt");
  page.may_back = true;
  for (const auto& [record, title] : attempts) {
    const char* const how = record.passed  ? msgid("Passed")
                            : record.aided ? msgid("Not passed: aids were on")
                                           : msgid("Not passed");
    page.choices.push_back({title,
                            local_time(record.started),
                            record.passed ? Tone::good : Tone::plain,
                            {{translate(language, how)},
                             {fill(translate(language, "Score {} of 100, {} s"),
                                   {std::to_string(whole_points(record.score)),
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
  if (scenario.find.empty()) choices.push_back({BriefingChoice::Kind::learn, ""});
  return choices;
}

Page make_briefing_page(const Scenario& scenario, const std::set<std::string>& asked,
                        const std::string& side, const std::shared_ptr<const PagePicture>& picture,
                        const KeyMap& keys, Language language) {
  Page page;
  page.name = "briefing";
  page.title = title_words(language, scenario);
  page.may_back = true;
  page.lines = {{goal_words(scenario, language)}};
  const Vec3 entry_P = scenario.X_JP.inverse() * scenario.entry.centre;
  if (scenario.find.empty() && scenario.entry.plane == "in")
    page.lines.push_back({translate(
        language, entry_P.x() < 0
                      ? msgid("The needle goes in at the end of the probe that has the mark")
                      : msgid("The needle goes in at the end of the probe without the mark"))});
  page.lines.push_back({instrument_words(scenario, language)});
  add_syringe(scenario, language, page.lines);
  page.lines.push_back(
      {fill(translate(language, "Time: {} s"), {number(language, scenario.time_limit, 0)})});
  add_hands(scenario, keys, language, page.lines);
  if (scenario.aided())
    page.lines.push_back(
        {translate(language, "With aids on you cannot pass; each success makes them fainter."),
         Tone::dim});
  std::vector<PageLine> about;
  if (scenario.find.empty())
    about.push_back(
        {translate(language, "The picture: how it looks with the needle in place"), Tone::dim});
  add_marks(scenario, language, about);
  for (const BriefingChoice& choice : briefing_choices(scenario)) {
    std::string name =
        translate(language, scenario.aided() ? msgid("Begin without aids: only that counts")
                                             : msgid("Begin"));
    std::string beside;
    if (choice.kind == BriefingChoice::Kind::begin_aided)
      name = translate(language, "Begin with aids");
    if (choice.kind == BriefingChoice::Kind::learn)
      name =
          translate(language, "Learn it first: what it looks like, the expert, one hand at a time");
    if (const Question* question = find_question(choice.step)) {
      const bool answered = asked.count(choice.step) != 0;
      name = translate(language, question->asked);
      if (answered) beside = translate(language, answer_to(choice.step, side));
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
  page.name = "end";
  const bool all_held = std::all_of(judgement.marks.begin(), judgement.marks.end(),
                                    [](const JudgedMark& mark) { return mark.held; });
  page.title =
      translate(language, judgement.passed                  ? msgid("Passed")
                          : all_held && judgement.with_aids ? msgid("Not passed: aids were on")
                                                            : msgid("Not passed"));
  add_verdict(outcome, language, page.lines);
  add_left_out(outcome.played.measures, language, page.lines);
  if (!outcome.unrecorded.empty())
    page.lines.push_back(
        {fill(translate(language, "It is judged and kept, but cannot be reviewed: {}"),
              {said_by_system(language, outcome.unrecorded)}),
         Tone::bad});
  std::vector<PageLine> about;
  if (!feedback.faults.empty())
    about.push_back({translate(language, "What went wrong, the worst first"), Tone::heading});
  for (const Fault& fault : feedback.faults) {
    about.push_back({fill(translate(language, "{}: {}"),
                          {number(language, fault.time, 1) + " s", in_words(fault.what)}),
                     Tone::bad});
    about.push_back({fill(translate(language, "Why: {}"), {in_words(fault.cause)})});
    about.push_back({fill(translate(language, "Do: {}"), {in_words(fault.mend)}), Tone::good});
  }
  for (const AttemptEvent& event : outcome.seen_by_teacher)
    if (event.kind == "remark")
      about.push_back({fill(translate(language, "Teacher at {} s: {}"),
                            {number(language, event.time, 1), event.text})});
  if (!feedback.good.empty())
    about.push_back(
        {fill(translate(language, "Well done: {}"), {in_words(feedback.good)}), Tone::good});
  about.push_back({in_words(feedback.next)});
  for (const char* const choice :
       {msgid("Review the attempt"), msgid("Try again"), msgid("Next: {}"), msgid("Another task"),
        msgid("Someone else"), msgid("Open the report"), msgid("Leave")})
    page.choices.push_back(
        {fill(translate(language, choice), {next}), "", Tone::plain, about, nullptr});
  page.choices[static_cast<std::size_t>(AfterAttempt::report)].about = {
      {fill(translate(language, "Report: {}"), {outcome.report.string()}), Tone::dim}};
  return page;
}

Page make_preparing_page(TrainBodies& bodies, std::function<bool()> done, Language language) {
  Page page = make_busy_page(msgid("The body is being prepared ..."), std::move(done), language);
  page.lines = {
      {translate(language, "This is done once for each patient, and kept. It can take minutes.")}};
  page.bar = [&bodies, language] {
    const auto [step, fraction] = bodies.progress();
    return std::pair(said_by_system(language, step), fraction);
  };
  page.may_back = true;
  page.choices = {{translate(language, "Cancel"), "", Tone::plain, {}, nullptr}};
  return page;
}

Page make_busy_page(const char* what, std::function<bool()> done, Language language) {
  Page page;
  page.title = translate(language, what);
  page.done = std::move(done);
  return page;
}

}  // namespace artus
