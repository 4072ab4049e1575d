// SPDX-License-Identifier: AGPL-3.0-or-later
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "artus/apps/interrupts.h"
#include "artus/apps/session_options.h"
#include "artus/viewer/window.h"

namespace artus {
namespace {

struct ViewerOptions {
  SessionOptions session;
  WindowOptions window;
  std::filesystem::path script;
  bool report = false;
};

/// Where a user's window layout is kept between runs.
std::filesystem::path layout_file() {
  const char* config = std::getenv("XDG_CONFIG_HOME");  // NOLINT(concurrency-mt-unsafe): start-up
  const char* home = std::getenv("HOME");               // NOLINT(concurrency-mt-unsafe)
  std::filesystem::path folder;
  if (config != nullptr && *config != '\0')
    folder = config;
  else if (home != nullptr)
    folder = std::filesystem::path(home) / ".config";
  else
    return {};
  std::error_code error;
  std::filesystem::create_directories(folder / "artus", error);
  return error ? std::filesystem::path() : folder / "artus" / "layout.ini";
}

Result<void> read_script(const ViewerOptions& options, WindowOptions& window) {
  if (options.script.empty()) {
    if (window.layout.empty()) window.layout = layout_file();
    return {};
  }
  std::ifstream in(options.script);
  if (!in) return fail(ErrorCode::not_found, "cannot read the script", options.script);
  const std::string text((std::istreambuf_iterator<char>(in)), {});
  auto steps = parse_script(text, options.script);
  ARTUS_TRY(steps);
  window.script = std::move(*steps);
  window.quit_after_script = true;
  return {};
}

/// Knobs that other programs turned, until the window takes them over.
class RemoteTurns {
 public:
  void add(double ImageControls::*knob, double value) {
    const std::lock_guard<std::mutex> lock(mutex_);
    turns_.emplace_back(knob, value);
  }
  void take(ImageControls& controls) {
    const std::lock_guard<std::mutex> lock(mutex_);
    for (const auto& [knob, value] : turns_) controls.*knob = value;
    turns_.clear();
  }

 private:
  std::mutex mutex_;
  std::vector<std::pair<double ImageControls::*, double>> turns_;
};

ExitCode run_view(const ViewerOptions& options) {
  WindowOptions window = options.window;
  if (const auto script = read_script(options, window); !script)
    return report_error(script.error(), false);
  const auto joint = load(options.session.joint, make_progress_printer(false));
  if (!joint) return report_error(joint.error(), false);
  const auto params = make_session_params(options.session, **joint);
  if (!params) return report_error(params.error(), false);
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
  Session::Options session_options;
  session_options.haptic_wishes.cpu = options.session.haptic_cpu;
  session_options.recording = options.session.recording;
  session_options.share_images = options.session.input == "shared-memory";
  session_options.image_segment_prefix = options.session.prefix;
  if (*link)
    session_options.on_image = [&link](const ImageSnapshot& image) {
      (*link)->take_image(image);
    };
  const auto session = Session::start(std::make_shared<const Scene>(*joint), *params,
                                      std::move(*device), session_options);
  if (!session) return report_error(session.error(), false);
  if (*link) (*link)->attach(session->get());
  WindowReport report;
  const auto shown = run_window(**session, hand, first_target(**joint), window, report);
  if (*link) (*link)->attach(nullptr);
  if (options.report) {
    print_times((*session)->times(), (*session)->params());
    print_line("pose to screen", report.pose_to_screen);
  }
  if (!shown) return report_error(shown.error(), false);
  const auto written = write_histograms(options.session.histograms, (*session)->times());
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
  command->add_option("--width", window.width, "pixels")->capture_default_str();
  command->add_option("--height", window.height, "pixels")->capture_default_str();
  command->add_option("--window-rate", window.rate, "pictures a second, at most")
      ->capture_default_str();
  command
      ->add_option("--pixels-per-mm", window.pixels_per_mm,
                   "of the screen, for the image at true scale; 0: as the system says")
      ->capture_default_str();
  command->add_option("--layout", window.layout,
                      "where the panels' places are kept (default: the user's, none for scripts)");
  command->add_flag("--expert", window.expert, "without the 3D view");
  command->add_option("--script", options->script, "do what this file says, then end");
  command->add_option("--screenshot", window.screenshot, "PNG of the window at the script's end");
  command->add_option("--pictures", window.pictures, "folder of saved images")
      ->capture_default_str();
  command->add_flag("--report", options->report, "print where the time went at the end");
  on_run(command, code, [options] { return run_view(*options); });
}

}  // namespace artus
