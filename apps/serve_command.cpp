// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>
#include <cstdio>
#include <iostream>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>

#include <sys/resource.h>

#include "artus/detail/apps/options/interrupts.h"
#include "artus/detail/apps/options/live_metrics.h"
#include "artus/detail/apps/options/nested_ball.h"
#include "artus/detail/apps/options/scenario_options.h"
#include "artus/detail/apps/options/session_options.h"
#include "artus/detail/apps/options/tick_tally.h"
#include "artus/detail/session/liquid_at_tip.h"
#include "artus/detail/trainer/remote_controls.h"
#include "artus/detail/training/player.h"

namespace artus {
namespace {

struct ServeOptions {
  SessionOptions session;
  double seconds = 0;
  std::filesystem::path metrics;
  bool no_images = false;
  bool json = false;
};

/// Body and settings of a session.
struct Setting {
  std::shared_ptr<const Scene> scene;
  SessionParams params;
};

/// The flags' settings with the scenario's body, transducer, picture and needle.
Result<Setting> setting_of(const ServeOptions& options, const Scenario& scenario) {
  const auto scene = load_scene(scenario, {}, make_progress_printer(options.json));
  ARTUS_TRY(scene);
  auto params = make_session_params(options.session, (*scene)->joint());
  ARTUS_TRY(params);
  const auto own = make_session_params(scenario);
  ARTUS_TRY(own);
  params->transducer = own->transducer;
  params->image.depth = own->image.depth;
  params->image.seed = own->image.seed;
  params->needle_shape = own->needle_shape;
  params->feel.needle_length = own->feel.needle_length;
  params->syringe = own->syringe;
  params->aids = own->aids;
  ARTUS_TRY(validate(*params));
  return Setting{*scene, *params};
}

/// What sessions one after the other share; the pointers outlive them.
struct Serving {
  const ServeOptions* options;
  Interrupts* interrupts;
  const TrackerInput* tracker;
  SessionLink* link;  ///< may be null
  RemoteScenario* asked;
  std::int64_t end_ns = 0;  ///< set when the first session has started; 0: when interrupted
};

/// How long ticks do nothing first, so that it is known how late the machine is by itself: where
/// only the hands run, for a time.
double floor_seconds_of(const ServeOptions& options) {
  return options.no_images && options.seconds > 0 ? 1 : 0;
}

/// The joint; for the simulated hand one may be left out.
Result<std::shared_ptr<const CompiledJoint>> load_body(const SessionOptions& options, bool json) {
  if (!options.joint.joint.empty()) return load(options.joint, make_progress_printer(json));
  if (options.input == "injection") return make_nested_ball();
  return fail(ErrorCode::invalid, "name a joint; --input injection alone goes without", "--joint");
}

void print_status(const Session& session) {
  HapticSnapshot now;
  if (!session.newest(now)) return;
  const auto& regions = session.scene().joint().regions;
  const auto liquid = liquid_at_tip(now);
  const std::string layer =
      liquid ? "liquid in " + regions[*liquid].name : regions[now.feedback.region].name;
  const Vec3 force(now.force_J[0], now.force_J[1], now.force_J[2]);
  std::fprintf(stderr,
               "device %-8s tick %llu image %llu  %-10s %-24s depth %6.2f mm  %5.2f N  status %x\n",
               to_string(now.input.device.state), static_cast<unsigned long long>(session.ticks()),
               static_cast<unsigned long long>(session.frames()),
               to_string(static_cast<ContactState>(now.feedback.contact)), layer.c_str(),
               now.feedback.depth / kMillimetre, force.norm(), now.status);
}

/// The session's notices from `seen` on; returns how many there are.
std::size_t print_notices(const Session& session, std::size_t seen) {
  const std::vector<std::string> notices = session.notices();
  for (std::size_t i = seen; i < notices.size(); ++i)
    std::fprintf(stderr, "%s\n", notices[i].c_str());
  return notices.size();
}

void print_notices(SessionLink* link) {
  if (link == nullptr) return;
  for (const std::string& notice : link->server().take_notices())
    std::fprintf(stderr, "%s\n", notice.c_str());
}

/// Until the end, or until there is another scenario's setting to go on with.
std::optional<Setting> wait(const Session& session, const Serving& serving) {
  std::size_t seen = 0;
  for (;;) {
    double pause = 1;  // s
    if (serving.end_ns > 0) {
      const std::int64_t left = serving.end_ns - monotonic_ns();
      if (left <= 0) return std::nullopt;
      pause = std::min(pause, 1e-9 * static_cast<double>(left));
    }
    const bool interrupted = serving.interrupts->wait(pause);
    seen = print_notices(session, seen);
    print_notices(serving.link);
    if (interrupted) return std::nullopt;
    if (!serving.options->json) print_status(session);
    if (const auto scenario = serving.asked->take()) {
      auto next = setting_of(*serving.options, *scenario);
      if (next) return std::move(*next);
      std::fprintf(stderr, "%s\n", next.error().to_string().c_str());
    }
  }
}

/// MB that the process had in memory at most.
double peak_memory_mb() {
  constexpr double kKilobyte = 1024;  // ru_maxrss is in these
  rusage used{};
  getrusage(RUSAGE_SELF, &used);
  return static_cast<double>(used.ru_maxrss) * kKilobyte * 1e-6;
}

void report(const Session& session, const TickTally& tally, bool json) {
  if (json) {
    nlohmann::json all{{"joint", session.scene().joint().name},
                       {"rate_hz", session.params().haptic_rate},
                       {"ticks", session.ticks()},
                       {"frames", session.frames()},
                       {"overruns", session.overruns()},
                       {"unrecorded", session.unrecorded()},
                       {"peak_memory_mb", peak_memory_mb()},
                       {"refused", session.refusals()},
                       {"notices", session.notices()},
                       {"times", to_json(session.times())}};
    all.update(tally.to_json());
    std::cout << all.dump(2) << '\n';
    return;
  }
  print_times(session.times(), session.params());
  std::printf("%llu ticks, %llu images, %llu overruns, %llu records dropped, %.0f MB at most\n",
              static_cast<unsigned long long>(session.ticks()),
              static_cast<unsigned long long>(session.frames()),
              static_cast<unsigned long long>(session.overruns()),
              static_cast<unsigned long long>(session.unrecorded()), peak_memory_mb());
  tally.print();
}

/// The seconds that were asked for begin with the first tick: before it the system is asked for
/// priority and memory, and the floor is measured.
void await_first_tick(const Session& session, Interrupts& interrupts) {
  constexpr int kLongest = 3000;  // of 10 ms
  for (int i = 0; i < kLongest && session.ticks() == 0; ++i)
    if (interrupts.wait(0.01)) return;
}

/// One session to its end; what follows it, if anything.
Result<std::optional<Setting>> run_session(Serving& serving, const Setting& setting) {
  const ServeOptions& options = *serving.options;
  HandDevice* hand = nullptr;
  auto device =
      make_device(options.session, setting.params, setting.scene->joint(), *serving.tracker, &hand);
  ARTUS_TRY(device);
  Session::Options session_options = make_thread_options(options.session);
  session_options.images = !options.no_images;
  session_options.share_images = !options.no_images;
  session_options.gauge = options.seconds > 0;
  session_options.floor_seconds = floor_seconds_of(options);
  SessionLink* link = serving.link;
  if (link != nullptr)
    session_options.on_image = [link](const ImageSnapshot& image) {
      link->take_image(image);
    };
  const auto meter = make_live_meter(options.metrics, setting.scene, setting.params);
  ARTUS_TRY(meter);
  TickTally tally(meter->get());
  session_options.observer = &tally;
  auto session = Session::start(setting.scene, setting.params, std::move(*device), session_options);
  ARTUS_TRY(session);
  if (link != nullptr) link->attach(session->get());
  if (serving.end_ns == 0 && options.seconds > 0) {
    await_first_tick(**session, *serving.interrupts);
    serving.end_ns = monotonic_ns() + static_cast<std::int64_t>(1e9 * options.seconds);
  }
  auto next = wait(**session, serving);
  if (link != nullptr) link->attach(nullptr);
  for (const std::string& refused : (*session)->refusals())
    std::fprintf(stderr, "the system refused %s\n", refused.c_str());
  const auto histograms = write_histograms(options.session.histograms, (*session)->times());
  (*session)->stop();  // and what was measured rests
  report(**session, tally, options.json);
  const Result<void> recorded = (*session)->recorded();
  session->reset();
  ARTUS_TRY(recorded);
  ARTUS_TRY(histograms);
  ARTUS_TRY(write_live_metrics(options.metrics, meter->get()));
  return next;
}

ExitCode run_serve(const ServeOptions& options) {
  const auto joint = load_body(options.session, options.json);
  if (!joint) return report_error(joint.error(), options.json);
  const auto params = make_session_params(options.session, **joint);
  if (!params) return report_error(params.error(), options.json);
  Interrupts interrupts;
  const auto tracker = make_tracker_input(options.session.igtl);
  if (!tracker) return report_error(tracker.error(), options.json);
  RemoteScenario asked;
  if (!options.session.recording.empty() || !options.metrics.empty() ||
      !options.session.histograms.empty())
    asked.refuse("a session that is kept in a file takes no other scenario");
  const auto link =
      open_session_link(options.session.igtl, *tracker, {},
                        [&asked](const std::string& name) { return asked.ask(name); });
  if (!link) return report_error(link.error(), options.json);
  Serving serving{&options, &interrupts, &*tracker, link->get(), &asked};
  Setting setting{std::make_shared<const Scene>(*joint), *params};
  std::optional<Setting> before;  // to go back to, when a scenario does not start
  for (;;) {
    auto next = run_session(serving, setting);
    if (!next && !before) return report_error(next.error(), options.json);
    if (next && !*next) return ExitCode::ok;
    if (!next) {
      std::fprintf(stderr, "%s\n", next.error().to_string().c_str());
      setting = *std::exchange(before, std::nullopt);
      continue;
    }
    before = std::exchange(setting, std::move(**next));
  }
}

}  // namespace

void add_serve_command(Command& app, ExitCode& code) {
  auto options = std::make_shared<ServeOptions>();
  Command* command = add_command(
      app, "serve", "Run the engine for a device program in another process, without a window",
      "Reads POS, writes FORCE and IMAGE (docs/protocol.md) until it is interrupted.\n"
      "Examples:\n"
      "  artus serve -j meshes/simple-shoulder\n"
      "  artus serve -j real.artus --record session.rec --seconds 60 --json\n"
      "  artus serve -j real.artus --input injection --seconds 30     (what a session costs here)\n"
      "  artus serve --no-images --input injection --seconds 60 --haptic-rate 10000\n"
      "                                     (the hands alone: histograms, the machine's own "
      "delay)\n"
      "  artus serve -j real.artus --igtl 18944 --input igtl --calibration tracker.toml");
  add_session_options(command, options->session, "shared-memory");
  command->get_option("--joint")->required(false)->description(
      "joint folder or compiled file; with --input injection none: six tissues as nested spheres");
  command
      ->add_option("--seconds", options->seconds,
                   "stop after this time; 0: when interrupted. Then a fixed work runs beside, too: "
                   "what its time spreads is the machine's")
      ->check(number_in(0, 86400));
  add_live_metrics_option(command, options->metrics);
  command->add_flag("--no-images", options->no_images,
                    "draw nothing and write no IMAGE; tissue gives way all the same");
  command->add_flag("--json", options->json, "machine-readable report at the end");
  on_run(command, code, [options] { return run_serve(*options); });
}

}  // namespace artus
