// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>
#include <cstdio>
#include <memory>
#include <utility>

#include "artus/detail/apps/hands_command.h"
#include "artus/detail/apps/options/hand_options.h"
#include "artus/detail/apps/options/interrupts.h"
#include "artus/detail/apps/options/scenario_options.h"
#include "artus/detail/apps/options/session_options.h"
#include "artus/detail/apps/options/window_options.h"
#include "artus/detail/apps/training_commands.h"
#include "artus/detail/core/text_file.h"
#include "artus/detail/exchange/reference_frame.h"
#include "artus/detail/trainer/flow.h"
#include "artus/detail/trainer/hands_pages.h"
#include "artus/detail/trainer/teacher_server.h"
#include "artus/detail/trainer/told_file.h"
#include "artus/detail/trainer/trouble.h"
#include "artus/detail/training/patient_plans.h"
#include "artus/detail/viewer/input/window_events.h"

namespace artus {
namespace {

struct TrainCommandOptions {
  SessionOptions session;
  WindowOptions window;
  std::string language;
  std::filesystem::path script;
  std::filesystem::path records;
  std::filesystem::path attempts;
  TrainOptions train;
  std::string hands;           // webcam, a file or a folder: the kit's camera
  std::filesystem::path kit;   // its file
  std::filesystem::path told;  // what the window says, a line a time
  std::string teacher;         // where a teacher's browser can look on
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

/// The bundled scenarios by level, and one from a file; all of the patient that is wished for.
Result<std::vector<Scenario>> scenarios_of(const TrainCommandOptions& options) {
  std::vector<Scenario> all;
  for (const std::string_view text : bundled_scenario_texts()) {
    auto scenario = parse_scenario(text, "bundled");
    ARTUS_TRY(scenario);
    all.push_back(std::move(*scenario));
  }
  if (!options.train.scenario.empty()) {
    auto asked = find_scenario(options.train.scenario);
    ARTUS_TRY(asked);
    const bool known = std::any_of(all.begin(), all.end(), [&](const Scenario& s) {
      return s.name == asked->name && s.text == asked->text;
    });
    if (!known) all.push_back(std::move(*asked));
  }
  for (Scenario& scenario : all) {
    if (options.train.patient.empty() || scenario.joint.empty()) continue;
    auto other = of_patient(scenario, options.train.patient);
    ARTUS_TRY(other);
    scenario = std::move(*other);
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const Scenario& a, const Scenario& b) { return a.level < b.level; });
  return all;
}

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

/// --hands: poses come by OpenIGTLink from artus-hands, which this program starts. Nothing without
/// that flag.
Result<HandsSetup> take_hands(TrainCommandOptions& options) {
  constexpr double kHold = 100;  // ms: a camera of 30 Hz may miss two pictures
  if (options.hands.empty()) return HandsSetup();
  SessionOptions& session = options.session;
  session.input = "igtl";
  if (session.igtl.listen.empty()) session.igtl.listen = "127.0.0.1:0";
  session.igtl.needle_hold_ms = std::max(session.igtl.needle_hold_ms, kHold);
  auto program = find_hands_program();
  ARTUS_TRY(program);
  const auto beside = std::filesystem::absolute(options.records).parent_path();
  if (options.kit.empty()) options.kit = beside / "hands.toml";
  return HandsSetup{*program, options.hands, options.kit, beside / "hands-prints"};
}

/// The first page, then the program that sees the hands, giving them to the session that listens;
/// null: someone left. Errors: invalid (--igtl connects out).
Result<std::unique_ptr<HandsProgram>> begin_hands(Screen& screen, const PageOptions& pages,
                                                  const HandsSetup& hands, SessionLink* link) {
  const int port = link == nullptr ? 0 : link->server().port();
  if (port == 0)
    return fail(ErrorCode::invalid, "--hands needs a port to give poses to: --igtl PORT", "--igtl");
  PageWindow first(screen, pages);
  const auto ready = lead_to_hands(first, hands, pages.language);
  ARTUS_TRY(ready);
  if (!*ready) return std::unique_ptr<HandsProgram>();
  return std::make_unique<HandsProgram>(
      hands.program, std::vector<std::string>{"run", hands.source, "-k", hands.kit.string(),
                                              "--connect", "127.0.0.1:" + std::to_string(port)});
}

/// The middle of the block is where the task's probe stands at first, unless the calibration says
/// where it is.
void register_by_task(const TrackerInput& tracker, AttemptSetup& setup) {
  setup.input = kPaperHands;
  if (tracker.calibration.registered) return;
  setup.before_attempt = [inbox = tracker.inbox](const Scenario& scenario) {
    inbox->register_at(block_in_joint(scenario.X_JP));
  };
}

/// What the session's flags mean for attempts. `options` and `tracker` outlive it.
Result<AttemptSetup> setup_of(const SessionOptions& options, const TrackerInput& tracker) {
  const auto device = chosen_device(options.device, options.own_device);
  ARTUS_TRY(device);
  AttemptSetup setup;
  setup.device = *device;
  setup.input = options.input;
  if (options.input != "hand")
    setup.make_device = [&options, &tracker](const SessionParams& params,
                                             const CompiledJoint& joint) {
      HandDevice* hand = nullptr;
      return make_device(options, params, joint, tracker, &hand);
    };
  if (options.input == "igtl") setup.pose_hold = 1e-3 * options.igtl.needle_hold_ms;
  setup.insertion = tracker.calibration.insertion;
  setup.rigid = options.rigid;
  setup.image_threads = options.threads;
  setup.haptic_cpu = options.haptic_cpu;
  setup.share_images = options.input == "shared-memory";
  setup.prefix = options.prefix;
  return setup;
}

/// Where --teacher says, told on stderr; null without it.
Result<std::unique_ptr<TeacherServer>> open_teacher(const TrainCommandOptions& options,
                                                    TeacherBoard& board) {
  if (options.teacher.empty()) return std::unique_ptr<TeacherServer>();
  const auto where = igtl::parse_address(options.teacher, "--teacher");
  ARTUS_TRY(where);
  auto server =
      TeacherServer::open(board, {where->address, where->port, "", language_of(options.language)});
  ARTUS_TRY(server);
  std::fprintf(stderr, "a teacher can look on at %s\n", (*server)->link().c_str());
  return server;
}

/// Pages and windows that tell a file what they say; an empty path: nobody.
Result<void> tell_to_file(const std::filesystem::path& file, PageOptions& pages,
                          WindowOptions& window) {
  if (file.empty()) return {};
  auto opened = ToldFile::open(file);
  ARTUS_TRY(opened);
  const auto told = std::make_shared<ToldFile>(std::move(*opened));
  pages.watch = [told](const Page& page) {
    told->tell(page);
  };
  window.watch = [told](const WindowStatus& status) {
    told->tell(status);
  };
  return {};
}

Result<void> train(TrainCommandOptions options) {
  ARTUS_TRY(take_places(options));
  PageScript script;
  if (options.script.empty()) {
    take_own_keys(options.window);
  } else {
    auto steps = read_script(options.script);
    ARTUS_TRY(steps);
    script = PageScript(std::move(*steps));
  }
  auto scenarios = scenarios_of(options);
  ARTUS_TRY(scenarios);
  const auto hands = take_hands(options);
  ARTUS_TRY(hands);
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
  PageOptions pages{options.window.language, std::move(*keys), options.window.font_scale, &script,
                    options.window.asked_to_close};
  ARTUS_TRY(tell_to_file(options.told, pages, options.window));
  auto desk = open_desk(**screen, pages, options.records, options.attempts);
  ARTUS_TRY(desk);
  RemoteTurns turns;
  RemoteScenario remote;
  remote.refuse("nobody has said yet who trains");
  const auto link = open_session_link(
      options.session.igtl, *tracker,
      [&turns](double ImageControls::*knob, double value) { turns.add(knob, value); },
      [&remote](const std::string& name) { return remote.ask(name); });
  ARTUS_TRY(link);
  auto setup = setup_of(options.session, *tracker);
  ARTUS_TRY(setup);
  std::unique_ptr<HandsProgram> seeing;
  if (!options.hands.empty()) {
    auto begun = begin_hands(**screen, pages, *hands, link->get());
    ARTUS_TRY(begun);
    if (!*begun) return {};
    seeing = std::move(*begun);
    register_by_task(*tracker, *setup);
  }
  const SceneLoader load = [](const Scenario& scenario, const std::filesystem::path& joint,
                              const Progress& progress) {
    return load_scene(scenario, joint, progress);
  };
  TeacherBoard board;
  const auto teacher = open_teacher(options, board);
  ARTUS_TRY(teacher);
  const TrainContext room{screen->get(), &*desk,          &*setup,
                          load,          &options.window, &script,
                          link->get(),   &turns,          *teacher ? &board : nullptr};
  return run_training(options.train, room, std::move(pages), std::move(*scenarios), remote);
}

/// What holds where no flag says otherwise.
TrainCommandOptions first_options() {
  TrainCommandOptions options;
  options.session.input = "hand";
  options.session.device = "virtuose_6d_desktop";
  return options;
}

}  // namespace

ExitCode start_training(const WindowOptions& window, const std::string& language) {
  TrainCommandOptions options = first_options();
  options.window.width = window.width;
  options.window.height = window.height;
  options.window.font_scale = window.font_scale;
  options.window.left_handed = window.left_handed;
  options.window.keys = window.keys;
  options.language = language;
  const auto trained = train(options);
  return trained ? ExitCode::ok : report_error(trained.error(), false);
}

void add_train_command(Command& app, ExitCode& code) {
  auto options = std::make_shared<TrainCommandOptions>(first_options());
  Command* command = add_command(
      app, "train", "The trainer: who, what, briefing, attempt, verdict and review in one window",
      "Records and attempts are kept for each user, or where the flags say.\n"
      "Examples:\n"
      "  artus train                                                  mouse, keyboard or gamepad\n"
      "  artus train --records school.db --cohort 2026 --input shared-memory --device touch\n"
      "  artus train gel-find --person grey-heron-42\n"
      "  artus train mine.toml --igtl 18944 --input igtl\n"
      "  artus train --teacher 8090                                   a teacher's browser looks "
      "on\n"
      "  artus train --hands webcam                                   a webcam and printed "
      "markers");
  command->add_option("scenario", options->train.scenario,
                      "a file, or the name of a bundled one; else the window asks");
  command->add_option("--person", options->train.person, "who trains; else the window asks");
  command->add_option("--cohort", options->train.cohort, "group that someone new belongs to");
  command->add_option("--records", options->records,
                      "file of the records (default: records.db in ~/.local/share/artus)");
  command->add_option("--attempts", options->attempts,
                      "folder of the attempts (default: attempts, beside the records)");
  command->add_option("--joint,-j", options->train.joint, "in place of the scenarios' own");
  add_patient_option(command, options->train.patient);
  SessionOptions& session = options->session;
  command
      ->add_option("--input", session.input,
                   "hand (mouse, keyboard, gamepad), shared-memory, igtl (a tracker, see --igtl), "
                   "or a recording")
      ->capture_default_str();
  command->add_option("--hands", options->hands,
                      "hands that a camera sees (docs/hands.md): webcam, webcam:NUMBER, a video or "
                      "a folder of pictures");
  command->add_option("--kit", options->kit,
                      "file of the kit's measures (default: hands.toml, beside the records)");
  command->add_option("--teacher", options->teacher,
                      "[ADDRESS:]PORT of a page on which a teacher's browser follows the attempt, "
                      "freezes, points, switches aids and says something; without an address this "
                      "machine alone, with one whoever has the token that is printed; port 0: any");
  add_device_option(command, session.device);
  add_prefix_option(command, session.prefix);
  command->add_option("--haptic-cpu", session.haptic_cpu, "processor of the haptic thread; -1: any")
      ->check(whole_number_in(-1, 1023))
      ->capture_default_str();
  add_threads_option(command, session.threads);
  add_rigid_option(command, session.rigid);
  add_igtl_options(command, session.igtl);
  add_window_options(command, options->window, options->language);
  command->add_option("--script", options->script, "do what this file says, then end");
  command->add_option("--told", options->told,
                      "write what the window says to this file, a JSON object a line");
  on_run(command, code, [options] {
    const auto trained = train(*options);
    return trained ? ExitCode::ok : report_error(trained.error(), false);
  });
}

}  // namespace artus
