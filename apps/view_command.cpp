// SPDX-License-Identifier: AGPL-3.0-or-later
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "artus/detail/apps/options/interrupts.h"
#include "artus/detail/apps/options/live_metrics.h"
#include "artus/detail/apps/options/session_options.h"
#include "artus/detail/apps/options/window_options.h"
#include "artus/detail/apps/training_commands.h"
#include "artus/detail/trainer/remote_controls.h"
#include "artus/detail/viewer/joint3d/surface_detail.h"
#include "artus/detail/viewer/window.h"

namespace artus {
namespace {

constexpr double kDopplerLimit = 0.05;  // m/s; assumed: a needle that is jiggled does not wrap

struct ViewerOptions {
  SessionOptions session;
  WindowOptions window;
  std::string language;  // empty: as the system's
  std::filesystem::path script;
  std::filesystem::path metrics;
  bool report = false;
};

/// The script's steps, or a person's own places and keys.
Result<void> take_script(const ViewerOptions& options, WindowOptions& window) {
  if (options.script.empty()) {
    const std::filesystem::path folder = config_folder();
    if (window.layout.empty() && window.screenshot.empty() && !folder.empty())
      window.layout = folder / "layout.txt";
    take_own_keys(window);
    return {};
  }
  auto steps = read_script(options.script);
  ARTUS_TRY(steps);
  window.script = std::move(*steps);
  window.quit_after_script = true;
  return {};
}

/// How the device of this input is brought to life, when it was never there.
std::string connect_hint(const SessionOptions& session, Language language) {
  if (session.input == "shared-memory")
    return fill(translate(language,
                          "no device yet: start a program that writes {} (docs/protocol.md), or: "
                          "artus view --input hand"),
                {"/dev/shm/" + session.prefix + "POS"});
  if (session.input == "igtl")
    return translate(language,
                     "no tracker yet: let it send transforms to this machine by OpenIGTLink "
                     "(docs/openigtlink.md)");
  return translate(language, "no device yet: artus view --input hand needs none");
}

/// The person around the joint, goals, starts, language and keys of the window.
Result<void> prepare_window(const ViewerOptions& options, const CompiledJoint& joint,
                            WindowOptions& window) {
  auto outside = read_outside(named_joint(options.session.joint));
  ARTUS_TRY(outside);
  window.outside = std::move(*outside);
  const auto chosen = chosen_injection(options.session, joint);
  ARTUS_TRY(chosen);
  const auto plans = make_plan(options.session.plan, joint);
  ARTUS_TRY(plans);
  for (const PlannedInjection& plan : *plans)
    window.tasks.push_back({plan, first_target(joint, plan)});
  window.task = static_cast<std::size_t>(options.session.injection - 1);
  window.language = language_of(options.language);
  window.connect = connect_hint(options.session, window.language);
  window.welcome = options.session.input == "hand" && window.script.empty() &&
                   window.screenshot.empty() && !window.expert;
  window.training = window.welcome;
  return {};
}

void print_report(const Session& session, const WindowReport& report) {
  print_times(session.times(), session.params());
  print_line("pose to screen", report.pose_to_screen);
  print_line("window interval", report.interval);
  print_line("3D view", report.joint);
  std::printf("3D view at detail %zu of %zu\n", report.joint_level, DetailChooser::kLevels - 1);
}

/// `training`: whether the window led there.
ExitCode run_view(const ViewerOptions& options, bool& training) {
  WindowOptions window = options.window;
  if (const auto script = take_script(options, window); !script)
    return report_error(script.error(), false);
  const auto joint = load(options.session.joint, make_progress_printer(false));
  if (!joint) return report_error(joint.error(), false);
  auto params = make_session_params(options.session, **joint);
  if (!params) return report_error(params.error(), false);
  params->image.doppler = true;
  params->image.doppler_limit = kDopplerLimit;
  if (const auto ready = prepare_window(options, **joint, window); !ready)
    return report_error(ready.error(), false);
  Interrupts interrupts;
  window.asked_to_close = [&interrupts] {
    return interrupts.wait(0);
  };
  const auto tracker = make_tracker_input(options.session.igtl);
  if (!tracker) return report_error(tracker.error(), false);
  HandDevice* hand = nullptr;
  auto device = make_device(options.session, *params, **joint, *tracker, &hand);
  if (!device) return report_error(device.error(), false);
  RemoteTurns turns;
  window.turn_knobs = [&turns](ImageControls& controls) {
    turns.take(controls);
  };
  const auto link = open_session_link(
      options.session.igtl, *tracker,
      [&turns](double ImageControls::*knob, double value) { turns.add(knob, value); });
  if (!link) return report_error(link.error(), false);
  Session::Options session_options = make_thread_options(options.session);
  session_options.share_images = options.session.input == "shared-memory";
  session_options.extra_scene_holders = 1;
  if (*link)
    session_options.on_image = [&link](const ImageSnapshot& image) {
      (*link)->take_image(image);
    };
  const auto scene = std::make_shared<const Scene>(*joint);
  const auto meter = make_live_meter(options.metrics, scene, *params);
  if (!meter) return report_error(meter.error(), false);
  session_options.observer = meter->get();
  auto session = Session::start(scene, *params, std::move(*device), session_options);
  if (!session) return report_error(session.error(), false);
  if (*link) (*link)->attach(session->get());
  WindowReport report;
  const std::optional<PlannedInjection> plan =
      window.tasks.empty() ? std::nullopt : std::optional(window.tasks[window.task].injection);
  const auto shown = run_window(**session, hand, first_target(**joint, plan), window, report);
  training = report.training;
  if (*link) (*link)->attach(nullptr);
  if (options.report) print_report(**session, report);
  if (!shown) return report_error(shown.error(), false);
  auto written = write_histograms(options.session.histograms, (*session)->times());
  (*session)->stop();  // and what was measured rests
  if (written) written = (*session)->recorded();
  session->reset();
  if (written) written = write_live_metrics(options.metrics, meter->get());
  return written ? ExitCode::ok : report_error(written.error(), false);
}

}  // namespace

void add_view_command(Command& app, ExitCode& code) {
  auto options = std::make_shared<ViewerOptions>();
  Command* command = add_command(app, "view", "The window: joint, B-mode image, forces, rates",
                                 "Examples:\n"
                                 "  artus view -j meshes/simple-shoulder                          "
                                 "mouse and keyboard; F1 helps\n"
                                 "  artus view -j real.artus --input shared-memory --expert\n"
                                 "  xvfb-run artus view -j meshes/simple-shoulder --script "
                                 "docs/view.script --screenshot out.png");
  add_session_options(command, options->session, "hand");
  WindowOptions& window = options->window;
  add_window_options(command, window, options->language);
  command->add_flag("--plain", window.plain, "saved images without ruler, settings and names");
  command->add_option("--pseudonym", window.patient, "of the patient, written on the image");
  command
      ->add_option("--pixels-per-mm", window.pixels_per_mm,
                   "of the screen, for the image at true scale; 0: as the system says")
      ->check(number_in(0, 100))
      ->capture_default_str();
  command->add_option("--layout", window.layout,
                      "where the panels' places are kept (default: the user's, none for scripts)");
  command->add_flag("--expert", window.expert, "without the 3D view");
  command->add_option("--script", options->script, "do what this file says, then end");
  command->add_option("--screenshot", window.screenshot,
                      "PNG of the window: at the script's end, or, without one, "
                      "as soon as picture and 3D view are there; then it ends");
  command->add_option("--pictures", window.pictures, "folder of saved images")
      ->capture_default_str();
  add_live_metrics_option(command, options->metrics);
  command->add_flag("--report", options->report, "print where the time went at the end");
  on_run(command, code, [options] {
    bool training = false;
    const ExitCode viewed = run_view(*options, training);
    return viewed == ExitCode::ok && training ? start_training(options->window, options->language)
                                              : viewed;
  });
}

}  // namespace artus
