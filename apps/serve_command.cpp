// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>
#include <cstdio>
#include <iostream>
#include <memory>

#include "artus/apps/interrupts.h"
#include "artus/apps/live_metrics.h"
#include "artus/apps/session_options.h"

namespace artus {
namespace {

struct ServeOptions {
  SessionOptions session;
  double seconds = 0;
  std::filesystem::path metrics;
  bool no_images = false;
  bool json = false;
};

void print_status(const Session& session) {
  HapticSnapshot now;
  if (!session.newest(now)) return;
  const std::string& layer = session.scene().joint().regions[now.feedback.region].name;
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

void wait(const Session& session, SessionLink* link, Interrupts& interrupts,
          const ServeOptions& options) {
  const double seconds = options.seconds;
  const std::int64_t end = monotonic_ns() + static_cast<std::int64_t>(seconds * 1e9);
  std::size_t seen = 0;
  for (;;) {
    double pause = 1;  // s
    if (seconds > 0) {
      const std::int64_t left = end - monotonic_ns();
      if (left <= 0) return;
      pause = std::min(pause, 1e-9 * static_cast<double>(left));
    }
    const bool interrupted = interrupts.wait(pause);
    seen = print_notices(session, seen);
    print_notices(link);
    if (interrupted) return;
    if (!options.json) print_status(session);
  }
}

void report(const Session& session, bool json) {
  if (json) {
    std::cout << nlohmann::json{{"ticks", session.ticks()},
                                {"frames", session.frames()},
                                {"overruns", session.overruns()},
                                {"unrecorded", session.unrecorded()},
                                {"refused", session.refusals()},
                                {"notices", session.notices()},
                                {"times", to_json(session.times())}}
                     .dump(2)
              << '\n';
    return;
  }
  print_times(session.times(), session.params());
  std::printf("%llu ticks, %llu images, %llu overruns, %llu records dropped\n",
              static_cast<unsigned long long>(session.ticks()),
              static_cast<unsigned long long>(session.frames()),
              static_cast<unsigned long long>(session.overruns()),
              static_cast<unsigned long long>(session.unrecorded()));
}

ExitCode run_serve(const ServeOptions& options) {
  const auto joint = load(options.session.joint, make_progress_printer(options.json));
  if (!joint) return report_error(joint.error(), options.json);
  const auto params = make_session_params(options.session, **joint);
  if (!params) return report_error(params.error(), options.json);
  Interrupts interrupts;
  const auto tracker = make_tracker_input(options.session.igtl);
  if (!tracker) return report_error(tracker.error(), options.json);
  HandDevice* hand = nullptr;
  auto device = make_device(options.session, *params, **joint, *tracker, &hand);
  if (!device) return report_error(device.error(), options.json);
  const auto link = open_session_link(options.session.igtl, *tracker);
  if (!link) return report_error(link.error(), options.json);
  Session::Options session_options;
  session_options.haptic_wishes.cpu = options.session.haptic_cpu;
  session_options.recording = options.session.recording;
  session_options.images = !options.no_images;
  session_options.share_images = !options.no_images;
  session_options.image_segment_prefix = options.session.prefix;
  if (*link)
    session_options.on_image = [&link](const ImageSnapshot& image) {
      (*link)->take_image(image);
    };
  const auto scene = std::make_shared<const Scene>(*joint);
  const auto meter = make_live_meter(options.metrics, scene, *params);
  if (!meter) return report_error(meter.error(), options.json);
  session_options.witness = meter->get();
  auto session = Session::start(scene, *params, std::move(*device), session_options);
  if (!session) return report_error(session.error(), options.json);
  if (*link) (*link)->attach(session->get());
  wait(**session, link->get(), interrupts, options);
  if (*link) (*link)->attach(nullptr);
  for (const std::string& refused : (*session)->refusals())
    std::fprintf(stderr, "the system refused %s\n", refused.c_str());
  report(**session, options.json);
  auto written = write_histograms(options.session.histograms, (*session)->times());
  session->reset();  // ends it, and what was measured rests
  if (written) written = write_live_metrics(options.metrics, meter->get());
  return written ? ExitCode::ok : report_error(written.error(), options.json);
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
      "  artus serve -j meshes/simple-shoulder --input injection --seconds 10\n"
      "  artus serve -j real.artus --igtl 18944 --input igtl --calibration tracker.toml");
  add_session_options(command, options->session, "shared-memory");
  command->add_option("--seconds", options->seconds, "stop after this time; 0: when interrupted")
      ->check(number_in(0, 86400));
  add_live_metrics_option(command, options->metrics);
  command->add_flag("--no-images", options->no_images, "draw nothing and write no IMAGE");
  command->add_flag("--json", options->json, "machine-readable report at the end");
  on_run(command, code, [options] { return run_serve(*options); });
}

}  // namespace artus
