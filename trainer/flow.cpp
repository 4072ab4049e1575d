// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/trainer/flow.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

#include "artus/detail/reports/mark_words.h"
#include "artus/detail/trainer/learn_flow.h"
#include "artus/detail/trainer/pages.h"
#include "artus/detail/trainer/review.h"
#include "artus/detail/trainer/trouble.h"
#include "artus/detail/training/patient_plans.h"

namespace artus {
namespace {

/// One after the other: who, what, briefing, attempt, verdict; and again.
class TrainFlow {
 public:
  TrainFlow(const TrainOptions& options, TrainContext room, PageOptions pages,
            std::vector<Scenario> scenarios, RemoteScenario& remote)
      : options_(options),
        room_(room),
        remote_(&remote),
        show_(*room.screen, std::move(pages)),
        language_(show_.options().language),
        scenarios_(std::move(scenarios)),
        bodies_(options.joint, room.load_scene) {}

  /// Until someone leaves or the window is closed.
  [[nodiscard]] Result<void> run() {
    Next next = Next::who;
    while (next != Next::leave) {
      auto after = step(next);
      if (!after) after = tell_trouble(next, after.error());
      ARTUS_TRY(after);
      next = *after;
    }
    return {};
  }

 private:
  enum class Next { who, what, earlier, briefing, learn, attempt, keep, end, leave };

  /// A page in place of what failed: the same again, another task, or out, with the failure as the
  /// program's. What the command line or a script says wrongly ends the program.
  Result<Next> tell_trouble(Next now, const Error& error) {
    const bool asked = error.where.rfind("--", 0) == 0 || error.where == "script";
    if (asked) return tl::unexpected<Error>(error);
    bodies_.forget(scenario_);
    const char* safe =
        now == Next::keep
            ? msgid("Your attempt is over and measured. It is kept here until it is stored.")
            : msgid("What was finished before is stored.");
    const bool may_go_on = !person_.empty() && now != Next::what;
    const auto answer = show(make_trouble_page(error, safe, may_go_on, language_));
    if (!answer || answer->kind != PageAnswer::Kind::chosen) return tl::unexpected<Error>(error);
    if (answer->choice == 0) return now;
    if (may_go_on && answer->choice == 1) return Next::what;
    return tl::unexpected<Error>(error);
  }

  Result<Next> step(Next now) {
    switch (now) {
      case Next::who:
        return who();
      case Next::what:
        return what();
      case Next::earlier:
        return earlier();
      case Next::briefing:
        return brief();
      case Next::learn:
        return learn();
      case Next::attempt:
        return attempt();
      case Next::keep:
        return keep();
      case Next::end:
        return end();
      case Next::leave:
        break;
    }
    return Next::leave;
  }

  Result<PageAnswer> show(Page page) { return show_.show(std::move(page)); }

  /// A page on which another program may choose the task, too: then it is done.
  Result<PageAnswer> offer(Page page) {
    remote_->refuse("");
    page.done = [this] {
      return remote_->asked();
    };
    auto answer = show(std::move(page));
    remote_->refuse("nobody is free for it now");
    return answer;
  }

  /// What another program asked for is briefed next.
  Next take_remote() {
    if (const auto scenario = remote_->take()) choose(*scenario);
    return Next::briefing;
  }

  Result<Next> who() {
    auto names = room_.desk->learners();
    ARTUS_TRY(names);
    if (!options_.person.empty() && person_.empty()) {
      if (std::find(names->begin(), names->end(), options_.person) == names->end())
        return fail(ErrorCode::not_found,
                    "the records have no learner '" + options_.person +
                        "': without --person the window makes one, or: artus learners add",
                    "--person");
      person_ = options_.person;
      return what_next();
    }
    std::vector<KnownLearner> learners;
    for (const std::string& name : *names) {
      auto tally = room_.desk->tally(name, "");
      ARTUS_TRY(tally);
      learners.push_back({name, *tally});
    }
    std::stable_sort(learners.begin(), learners.end(),
                     [](const auto& a, const auto& b) { return a.tally.last > b.tally.last; });
    const auto answer = show(make_who_page(learners, language_));
    ARTUS_TRY(answer);
    if (answer->kind != PageAnswer::Kind::chosen) return Next::leave;
    if (answer->choice < learners.size()) {
      person_ = learners[answer->choice].name;
      return what_next();
    }
    auto fresh = room_.desk->add_learner(options_.cohort);
    ARTUS_TRY(fresh);
    person_ = *fresh;
    const auto seen = show(make_welcome_page(person_, language_));
    ARTUS_TRY(seen);
    return seen->kind == PageAnswer::Kind::chosen ? what_next() : Result<Next>(Next::leave);
  }

  /// The scenario of the command line goes first, once.
  Result<Next> what_next() {
    if (options_.scenario.empty() || asked_for_) return Next::what;
    asked_for_ = true;
    auto asked = find_scenario(options_.scenario);
    ARTUS_TRY(asked);
    choose(*asked);
    if (!options_.patient.empty()) scenario_ = scenarios_[at_];  // that of the patient
    return Next::briefing;
  }

  void choose(const Scenario& scenario) {
    scenario_ = scenario;
    asked_.clear();
    for (std::size_t i = 0; i < scenarios_.size(); ++i)
      if (scenarios_[i].name == scenario.name) at_ = i;
  }

  Result<Next> what() {
    std::vector<OfferedTask> tasks;
    for (const Scenario& scenario : scenarios_) {
      auto tally = room_.desk->tally(person_, scenario.name);
      ARTUS_TRY(tally);
      tasks.push_back({scenario, *tally});
    }
    unlock_levels(tasks);
    const auto answer = offer(make_what_page(tasks, person_, bodies_, at_, language_));
    ARTUS_TRY(answer);
    if (answer->kind == PageAnswer::Kind::done) return take_remote();
    if (answer->kind == PageAnswer::Kind::back) return Next::who;
    if (answer->kind != PageAnswer::Kind::chosen) return Next::leave;
    if (answer->choice == tasks.size()) return Next::earlier;
    return tasks[answer->choice].open ? begin_task(tasks[answer->choice].scenario)
                                      : locked(tasks, answer->choice);
  }

  Result<Next> begin_task(const Scenario& scenario) {
    choose(scenario);
    return Next::briefing;
  }

  /// What opens a locked task, or the task all the same.
  Result<Next> locked(const std::vector<OfferedTask>& tasks, std::size_t wanted) {
    const Scenario& opener = tasks[opener_of(tasks, wanted)].scenario;
    const auto answer = show(make_locked_page(tasks[wanted].scenario, opener, language_));
    ARTUS_TRY(answer);
    if (answer->kind == PageAnswer::Kind::back) return Next::what;
    if (answer->kind != PageAnswer::Kind::chosen) return Next::leave;
    const bool anyway = static_cast<AfterLocked>(answer->choice) == AfterLocked::all_the_same;
    return begin_task(anyway ? tasks[wanted].scenario : opener);
  }

  /// Title of a scenario by its name; the name of one that is not offered.
  [[nodiscard]] std::string title_of(const std::string& name) const {
    for (const Scenario& scenario : scenarios_)
      if (scenario.name == name) return title_words(language_, scenario);
    return name;
  }

  /// An attempt of before: its verdict and all that follows from there.
  Result<Next> earlier() {
    auto records = room_.desk->finished(person_);
    ARTUS_TRY(records);
    std::vector<EarlierAttempt> attempts;
    for (const AttemptRecord& record : *records)
      attempts.push_back({record, title_of(record.scenario)});
    const auto answer = show(make_earlier_page(attempts, language_));
    ARTUS_TRY(answer);
    if (answer->kind == PageAnswer::Kind::back) return Next::what;
    if (answer->kind != PageAnswer::Kind::chosen) return Next::leave;
    const AttemptRecord& record = attempts[answer->choice].record;
    auto scenario = read_scenario(std::filesystem::path(record.folder) / "scenario.toml");
    ARTUS_TRY(scenario);
    choose(*scenario);
    const auto there = prepare();
    ARTUS_TRY(there);
    if (*there != Prepared::there) return *there == Prepared::closed ? Next::leave : Next::what;
    task_ = {person_, scenario_, scene_, outside_, {}, show_.options().keys, LedHand::none, {}};
    auto outcome = show_.meanwhile(msgid("The attempt is being read ..."),
                                   [&] { return read_attempt(*room_.desk, task_, record); });
    ARTUS_TRY(outcome);
    if (!*outcome) return Next::leave;
    outcome_ = std::move(**outcome);
    return Next::end;
  }

  enum class Prepared { there, given_up, closed };

  /// The scenario's body, with a page that shows how far it is while it is made.
  Result<Prepared> prepare() {
    const auto done = [this] {
      bodies_.prepare(scenario_);
      return bodies_.ready(scenario_);
    };
    if (!done()) {
      const auto waited = show(make_preparing_page(bodies_, done, language_));
      ARTUS_TRY(waited);
      if (waited->kind != PageAnswer::Kind::done) {
        bodies_.give_up();
        return waited->kind == PageAnswer::Kind::closed ? Prepared::closed : Prepared::given_up;
      }
    }
    auto scene = bodies_.scene(scenario_);
    ARTUS_TRY(scene);
    scene_ = *scene;
    auto outside = bodies_.outside(scenario_);
    ARTUS_TRY(outside);
    outside_ = std::move(*outside);
    follow_patient(scenario_, *scene_);
    return Prepared::there;
  }

  /// The body is made while the briefing is read.
  Result<Next> brief() {
    scene_.reset();
    auto tally = room_.desk->tally(person_, scenario_.name);
    ARTUS_TRY(tally);
    const Scenario offered = with_faded_aids(scenario_, *tally, true);
    const std::vector<BriefingChoice> choices = briefing_choices(offered);
    std::size_t at = 0;
    for (;;) {
      Page page = make_briefing_page(offered, asked_, scene_ == nullptr ? "" : scene_->joint().side,
                                     bodies_.picture(scenario_), show_.options().keys, language_);
      page.at = at;
      page.refresh = [this](Page& shown) {
        bodies_.prepare(scenario_);
        bodies_.want(scenario_);
        for (PageChoice& choice : shown.choices) choice.picture = bodies_.picture(scenario_);
      };
      if (at > 0) page.name.clear();  // the same page: the script's steps go on
      const auto answer = offer(std::move(page));
      ARTUS_TRY(answer);
      if (answer->kind == PageAnswer::Kind::done) return take_remote();
      if (answer->kind == PageAnswer::Kind::back) return Next::what;
      if (answer->kind != PageAnswer::Kind::chosen) return Next::leave;
      const BriefingChoice& choice = choices[answer->choice];
      const auto there = scene_ == nullptr ? prepare() : Result<Prepared>(Prepared::there);
      ARTUS_TRY(there);
      if (*there == Prepared::closed) return Next::leave;
      if (*there == Prepared::given_up) continue;
      if (choice.kind == BriefingChoice::Kind::learn) {
        learn_.begin();
        return Next::learn;
      }
      if (choice.kind != BriefingChoice::Kind::ask) {
        task_ = {
            person_,
            with_faded_aids(scenario_, *tally, choice.kind == BriefingChoice::Kind::begin_aided),
            scene_,
            outside_,
            asked_,
            show_.options().keys,
            LedHand::none,
            {}};
        return Next::attempt;
      }
      asked_.insert(choice.step);
      at = std::min(answer->choice + 1, choices.size() - 1);
    }
  }

  /// What is taught of a task before it is judged.
  Result<Next> learn() {
    task_ = {person_, scenario_, scene_, outside_, asked_, show_.options().keys, LedHand::none, {}};
    const auto after = learn_.step(task_);
    ARTUS_TRY(after);
    switch (*after) {
      case LearnFlow::After::again:
        return Next::learn;
      case LearnFlow::After::briefing:
        return Next::briefing;
      case LearnFlow::After::attempt:
        return Next::attempt;
      case LearnFlow::After::leave:
        break;
    }
    return Next::leave;
  }

  Result<Next> attempt() {
    show_.leave_screen();  // the session's window takes the screen
    auto outcome = run_attempt(room_, task_);
    ARTUS_TRY(outcome);
    outcome_ = std::move(*outcome);
    return outcome_.finished ? Next::keep : Next::leave;
  }

  /// What was measured is stored, as often as it takes.
  Result<Next> keep() {
    const auto kept =
        show_.meanwhile(msgid("The attempt is being stored ..."), [this]() -> Result<bool> {
          ARTUS_TRY(keep_attempt(room_, task_, outcome_));
          return true;
        });
    ARTUS_TRY(kept);
    if (!*kept) return Next::leave;
    return task_.led == LedHand::none ? Next::end : Next::learn;
  }

  /// The one that the feedback names; else the first above this one that was not passed, when this
  /// one was; else the same again.
  Result<std::size_t> next_task() {
    for (std::size_t i = 0; i < scenarios_.size(); ++i)
      if (scenarios_[i].name == outcome_.feedback.next_scenario) return i;
    if (!outcome_.played.judgement.passed) return at_;
    for (std::size_t i = at_ + 1; i < scenarios_.size(); ++i) {
      auto tally = room_.desk->tally(person_, scenarios_[i].name);
      ARTUS_TRY(tally);
      if (tally->passes == 0) return i;
    }
    return at_;
  }

  Result<Next> review() {
    if (outcome_.played.recording.ticks.empty())
      return fail(ErrorCode::unreadable,
                  "there is no recording of this attempt: " + outcome_.unrecorded,
                  outcome_.record.folder);
    const auto made = show_.meanwhile(msgid("The review is being prepared ..."),
                                      [this] { return make_review(task_, outcome_, language_); });
    ARTUS_TRY(made);
    if (!*made) return Next::leave;
    show_.leave_screen();
    const auto back = run_review(*room_.screen, show_.options(), **made);
    ARTUS_TRY(back);
    return *back ? Next::end : Next::leave;
  }

  /// The report in whatever shows pages on this machine; the verdict stays.
  Result<Next> open_report() {
    ARTUS_TRY(open_file(outcome_.report));
    return Next::end;
  }

  Result<Next> end() {
    const auto next = next_task();
    ARTUS_TRY(next);
    const auto answer =
        offer(make_end_page(outcome_, title_words(language_, scenarios_[*next]), language_));
    ARTUS_TRY(answer);
    if (answer->kind == PageAnswer::Kind::done) return take_remote();
    if (answer->kind != PageAnswer::Kind::chosen) return Next::leave;
    switch (static_cast<AfterAttempt>(answer->choice)) {
      case AfterAttempt::review:
        return review();
      case AfterAttempt::again:
        asked_.clear();
        return Next::briefing;
      case AfterAttempt::next:
        choose(scenarios_[*next]);
        return Next::briefing;
      case AfterAttempt::other:
        return Next::what;
      case AfterAttempt::who:
        return Next::who;
      case AfterAttempt::report:
        return open_report();
      case AfterAttempt::leave:
        break;
    }
    return Next::leave;
  }

  const TrainOptions& options_;
  TrainContext room_;
  RemoteScenario* remote_;
  PageShow show_;
  LearnFlow learn_{show_};
  Language language_;
  std::vector<Scenario> scenarios_;
  TrainBodies bodies_;
  std::string person_;
  Scenario scenario_;
  std::size_t at_ = 0;  // of scenarios_, the one that was chosen last
  std::set<std::string> asked_;
  bool asked_for_ = false;
  std::shared_ptr<const Scene> scene_;
  std::shared_ptr<const OutsideBody> outside_;  // around the scene's joint
  TrainTask task_;
  TrainOutcome outcome_;
};

}  // namespace

Result<void> run_training(const TrainOptions& options, const TrainContext& room, PageOptions pages,
                          std::vector<Scenario> scenarios, RemoteScenario& remote) {
  return TrainFlow(options, room, std::move(pages), std::move(scenarios), remote).run();
}

}  // namespace artus
