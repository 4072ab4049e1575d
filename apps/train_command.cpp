// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>
#include <chrono>
#include <future>
#include <memory>
#include <utility>

#include "artus/apps/interrupts.h"
#include "artus/apps/train_pages.h"
#include "artus/apps/train_review.h"
#include "artus/apps/training_commands.h"
#include "artus/apps/view_options.h"
#include "artus/apps/window_options.h"
#include "artus/core/text_file.h"
#include "artus/training/feedback.h"
#include "artus/viewer/window_events.h"

namespace artus {
namespace {

struct TrainCommandOptions {
  SessionOptions session;
  WindowOptions window;
  std::string language;
  std::filesystem::path script;
  std::filesystem::path records;
  std::filesystem::path attempts;
  std::filesystem::path joint;
  std::string person;
  std::string cohort;
  std::string scenario;
};

/// The keys that a file or the user's own says. Requires: an open screen. Errors: those of
/// KeyMap::parse.
Result<KeyMap> keys_of(const WindowOptions& window) {
  const Keyboard keyboard = find_keyboard();
  if (window.keys.empty()) return KeyMap(keyboard);
  const auto text = read_bytes(window.keys);
  ARTUS_TRY(text);
  return KeyMap::parse(*text, window.keys, keyboard);
}

/// The bundled scenarios by level, and one from a file.
Result<std::vector<Scenario>> scenarios_of(const TrainCommandOptions& options) {
  std::vector<Scenario> all;
  for (const std::string_view text : bundled_scenario_texts()) {
    auto scenario = parse_scenario(text, "bundled");
    ARTUS_TRY(scenario);
    all.push_back(std::move(*scenario));
  }
  if (!options.scenario.empty()) {
    auto asked = find_scenario(options.scenario);
    ARTUS_TRY(asked);
    const bool known = std::any_of(all.begin(), all.end(), [&](const Scenario& s) {
      return s.name == asked->name && s.text == asked->text;
    });
    if (!known) all.push_back(std::move(*asked));
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const Scenario& a, const Scenario& b) { return a.level < b.level; });
  return all;
}

/// One after the other: who, what, briefing, attempt, verdict; and again.
class TrainFlow {
 public:
  TrainFlow(const TrainCommandOptions& options, TrainRoom room, PageOptions pages,
            std::vector<Scenario> scenarios, RemoteScenario& remote)
      : options_(options),
        room_(room),
        remote_(&remote),
        page_options_(std::move(pages)),
        language_(page_options_.language),
        scenarios_(std::move(scenarios)),
        bodies_(options.joint) {}

  /// Until someone leaves or the window is closed.
  [[nodiscard]] Result<void> run() {
    Stage next = Stage::who;
    while (next != Stage::leave) {
      auto after = step(next);
      ARTUS_TRY(after);
      next = *after;
    }
    return {};
  }

 private:
  enum class Stage { who, what, briefing, attempt, end, leave };

  Result<Stage> step(Stage now) {
    switch (now) {
      case Stage::who:
        return who();
      case Stage::what:
        return what();
      case Stage::briefing:
        return brief();
      case Stage::attempt:
        return attempt();
      case Stage::end:
        return end();
      case Stage::leave:
        break;
    }
    return Stage::leave;
  }

  Result<PageAnswer> show(Page page) {
    if (!pages_) pages_ = std::make_unique<PageWindow>(*room_.screen, page_options_);
    return pages_->show(std::move(page));
  }

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
  Stage take_remote() {
    if (const auto scenario = remote_->take()) choose(*scenario);
    return Stage::briefing;
  }

  Result<Stage> who() {
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
    if (answer->kind != PageAnswer::Kind::chosen) return Stage::leave;
    if (answer->choice < learners.size()) {
      person_ = learners[answer->choice].name;
      return what_next();
    }
    auto fresh = room_.desk->add_learner(options_.cohort);
    ARTUS_TRY(fresh);
    person_ = *fresh;
    const auto seen = show(make_welcome_page(person_, language_));
    ARTUS_TRY(seen);
    return seen->kind == PageAnswer::Kind::chosen ? what_next() : Result<Stage>(Stage::leave);
  }

  /// The scenario of the command line goes first, once.
  Result<Stage> what_next() {
    if (options_.scenario.empty() || asked_for_) return Stage::what;
    asked_for_ = true;
    auto asked = find_scenario(options_.scenario);
    ARTUS_TRY(asked);
    choose(*asked);
    return Stage::briefing;
  }

  void choose(const Scenario& scenario) {
    scenario_ = scenario;
    asked_.clear();
    for (std::size_t i = 0; i < scenarios_.size(); ++i)
      if (scenarios_[i].name == scenario.name) at_ = i;
  }

  Result<Stage> what() {
    std::vector<OfferedTask> tasks;
    for (const Scenario& scenario : scenarios_) {
      auto tally = room_.desk->tally(person_, scenario.name);
      ARTUS_TRY(tally);
      tasks.push_back({scenario, *tally});
    }
    const auto answer = offer(make_what_page(tasks, person_, bodies_, at_, language_));
    ARTUS_TRY(answer);
    if (answer->kind == PageAnswer::Kind::done) return take_remote();
    if (answer->kind == PageAnswer::Kind::back) return Stage::who;
    if (answer->kind != PageAnswer::Kind::chosen) return Stage::leave;
    choose(tasks[answer->choice].scenario);
    return Stage::briefing;
  }

  /// The scenario's body, with a page that asks to wait while it is made. False: the window was
  /// closed meanwhile.
  Result<bool> prepare() {
    bodies_.want(scenario_);
    const auto done = [this] {
      bodies_.want(scenario_);
      return bodies_.ready(scenario_);
    };
    if (!done()) {
      const auto waited = show(make_busy_page(Said::busy_body, done, language_));
      ARTUS_TRY(waited);
      if (waited->kind != PageAnswer::Kind::done) return false;
    }
    auto scene = bodies_.scene(scenario_);
    ARTUS_TRY(scene);
    scene_ = *scene;
    return true;
  }

  Result<Stage> brief() {
    const auto there = prepare();
    ARTUS_TRY(there);
    if (!*there) return Stage::leave;
    auto tally = room_.desk->tally(person_, scenario_.name);
    ARTUS_TRY(tally);
    const Scenario offered = with_faded_aids(scenario_, *tally, true);
    const std::vector<BriefingChoice> choices = briefing_choices(offered);
    std::size_t at = 0;
    for (;;) {
      Page page = make_briefing_page(offered, asked_, scene_->joint().side,
                                     bodies_.picture(scenario_), page_options_.keys, language_);
      page.at = at;
      page.refresh = [this](Page& shown) {
        bodies_.want(scenario_);
        for (PageChoice& choice : shown.choices) choice.picture = bodies_.picture(scenario_);
      };
      if (at > 0) page.stage.clear();  // the same page: the script's steps go on
      const auto answer = offer(std::move(page));
      ARTUS_TRY(answer);
      if (answer->kind == PageAnswer::Kind::done) return take_remote();
      if (answer->kind == PageAnswer::Kind::back) return Stage::what;
      if (answer->kind != PageAnswer::Kind::chosen) return Stage::leave;
      const BriefingChoice& choice = choices[answer->choice];
      if (choice.kind != BriefingChoice::Kind::ask) {
        task_ = {
            person_,
            with_faded_aids(scenario_, *tally, choice.kind == BriefingChoice::Kind::begin_aided),
            scene_, asked_};
        return Stage::attempt;
      }
      asked_.insert(choice.step);
      at = std::min(answer->choice + 1, choices.size() - 1);
    }
  }

  Result<Stage> attempt() {
    pages_.reset();  // the session's window takes the screen
    auto outcome = run_attempt(room_, task_);
    ARTUS_TRY(outcome);
    outcome_ = std::move(*outcome);
    return outcome_.finished ? Stage::end : Stage::leave;
  }

  /// The first task above this one that was not passed, when this one was; else the one that the
  /// feedback names, or the same again.
  Result<std::size_t> next_task() {
    if (!outcome_.played.judgement.passed) {
      const auto told = make_feedback(outcome_.played.measures, outcome_.played.judgement).next;
      for (std::size_t i = 0; i < scenarios_.size(); ++i)
        if (told.find("(" + scenarios_[i].name + ")") != std::string::npos) return i;
      return at_;
    }
    for (std::size_t i = at_ + 1; i < scenarios_.size(); ++i) {
      auto tally = room_.desk->tally(person_, scenarios_[i].name);
      ARTUS_TRY(tally);
      if (tally->passes == 0) return i;
    }
    return at_;
  }

  Result<Stage> review() {
    auto making =
        std::async(std::launch::async, [this] { return make_review(task_, outcome_, language_); });
    const auto ready = [&making] {
      return making.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
    };
    const auto waited = show(make_busy_page(Said::busy_review, ready, language_));
    ARTUS_TRY(waited);
    const auto made = making.get();
    ARTUS_TRY(made);
    if (waited->kind != PageAnswer::Kind::done) return Stage::leave;
    pages_.reset();
    const auto back = run_review(*room_.screen, page_options_, *made);
    ARTUS_TRY(back);
    return *back ? Stage::end : Stage::leave;
  }

  Result<Stage> end() {
    const auto next = next_task();
    ARTUS_TRY(next);
    const auto answer = offer(make_end_page(outcome_, scenarios_[*next].title, language_));
    ARTUS_TRY(answer);
    if (answer->kind == PageAnswer::Kind::done) return take_remote();
    if (answer->kind != PageAnswer::Kind::chosen) return Stage::leave;
    switch (static_cast<AfterAttempt>(answer->choice)) {
      case AfterAttempt::review:
        return review();
      case AfterAttempt::again:
        asked_.clear();
        return Stage::briefing;
      case AfterAttempt::next:
        choose(scenarios_[*next]);
        return Stage::briefing;
      case AfterAttempt::other:
        return Stage::what;
      case AfterAttempt::who:
        return Stage::who;
      case AfterAttempt::leave:
        break;
    }
    return Stage::leave;
  }

  const TrainCommandOptions& options_;
  TrainRoom room_;
  RemoteScenario* remote_;
  PageOptions page_options_;
  Language language_;
  std::vector<Scenario> scenarios_;
  TrainBodies bodies_;
  std::unique_ptr<PageWindow> pages_;
  std::string person_;
  Scenario scenario_;
  std::size_t at_ = 0;  // of scenarios_, the one that was chosen last
  std::set<std::string> asked_;
  bool asked_for_ = false;
  std::shared_ptr<const Scene> scene_;
  TrainTask task_;
  TrainOutcome outcome_;
};

/// Where records and attempts are kept.
Result<void> take_places(TrainCommandOptions& options) {
  if (options.records.empty()) {
    const std::filesystem::path folder = data_folder();
    if (folder.empty())
      return fail(ErrorCode::unreadable, "there is no folder for records: name a file",
                  "--records");
    options.records = folder / "records.db";
  }
  if (options.attempts.empty())
    options.attempts = std::filesystem::absolute(options.records).parent_path() / "attempts";
  return {};
}

Result<void> train(TrainCommandOptions options) {
  ARTUS_TRY(take_places(options));
  StagedScript script;
  if (options.script.empty()) {
    take_own_keys(options.window);
  } else {
    auto steps = read_script(options.script);
    ARTUS_TRY(steps);
    script = StagedScript(std::move(*steps));
  }
  auto scenarios = scenarios_of(options);
  ARTUS_TRY(scenarios);
  auto desk = TrainDesk::open(options.records, options.attempts);
  ARTUS_TRY(desk);
  options.window.language = language_of(options.language);
  Interrupts interrupts;
  options.window.asked_to_close = [&interrupts] {
    return interrupts.wait(0);
  };
  const auto tracker = make_tracker_input(options.session.igtl);
  ARTUS_TRY(tracker);
  const auto screen = Screen::open(options.window.width, options.window.height);
  ARTUS_TRY(screen);
  auto keys = keys_of(options.window);
  ARTUS_TRY(keys);
  RemoteTurns turns;
  RemoteScenario remote;
  remote.refuse("nobody has said yet who trains");
  const auto link = open_session_link(
      options.session.igtl, *tracker,
      [&turns](double ImageControls::*knob, double value) { turns.add(knob, value); },
      [&remote](const std::string& name) { return remote.ask(name); });
  ARTUS_TRY(link);
  const TrainRoom room{screen->get(), &*desk,    &options.session, &options.window,
                       &script,       &*tracker, link->get(),      &turns};
  PageOptions pages{options.window.language, std::move(*keys), options.window.font_scale, &script,
                    options.window.asked_to_close};
  return TrainFlow(options, room, std::move(pages), std::move(*scenarios), remote).run();
}

}  // namespace

void add_train_command(Command& app, ExitCode& code) {
  auto options = std::make_shared<TrainCommandOptions>();
  Command* command = add_command(
      app, "train", "The trainer: who, what, briefing, attempt, verdict and review in one window",
      "Records and attempts are kept for each user, or where the flags say.\n"
      "Examples:\n"
      "  artus train                                                  mouse, keyboard or gamepad\n"
      "  artus train --records school.db --cohort 2026 --input shared-memory --device touch\n"
      "  artus train gel-find --person grey-heron-42\n"
      "  artus train mine.toml --igtl 18944 --input igtl");
  options->session.input = "hand";
  options->session.device = "virtuose_6d_desktop";
  command->add_option("scenario", options->scenario,
                      "a file, or the name of a bundled one; else the window asks");
  command->add_option("--person", options->person, "who trains; else the window asks");
  command->add_option("--cohort", options->cohort, "of someone new");
  command->add_option("--records", options->records,
                      "file of the records (default: records.db in ~/.local/share/artus)");
  command->add_option("--attempts", options->attempts,
                      "folder of the attempts (default: attempts, beside the records)");
  command->add_option("--joint,-j", options->joint, "in place of the scenarios' own");
  SessionOptions& session = options->session;
  command
      ->add_option("--input", session.input,
                   "hand (mouse, keyboard, gamepad), shared-memory, igtl (a tracker, see --igtl), "
                   "or a recording")
      ->capture_default_str();
  command
      ->add_option("--device", session.device,
                   "whose force limits hold: touch, virtuose_6d_desktop, delta, ideal")
      ->capture_default_str();
  add_prefix_option(command, session.prefix);
  command->add_option("--haptic-cpu", session.haptic_cpu, "processor of the haptic thread; -1: any")
      ->check(whole_number_in(-1, 1023))
      ->capture_default_str();
  command->add_option("--threads", session.threads, "of the imaging; 0: all processors")
      ->capture_default_str();
  add_igtl_options(command, session.igtl);
  add_window_options(command, options->window, options->language);
  command->add_option("--script", options->script, "do what this file says, then end");
  on_run(command, code, [options] {
    const auto trained = train(*options);
    return trained ? ExitCode::ok : report_error(trained.error(), false);
  });
}

}  // namespace artus
