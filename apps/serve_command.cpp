// SPDX-License-Identifier: AGPL-3.0-or-later
#include <csignal>
#include <cstdio>
#include <ctime>
#include <iostream>
#include <memory>

#include "artus/apps/session_options.h"

namespace artus {
namespace {

struct ServeOptions {
  SessionOptions session;
  double seconds = 0;
  bool no_images = false;
  bool json = false;
};

/// Interrupts are taken by the waiting thread alone; blocked before others start, which inherit it.
sigset_t block_interrupts() {
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, SIGINT);
  sigaddset(&set, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &set, nullptr);
  return set;
}

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

void wait(const Session& session, const sigset_t& interrupts, double seconds, bool quiet) {
  const std::int64_t end = monotonic_ns() + static_cast<std::int64_t>(seconds * 1e9);
  for (;;) {
    timespec pause{1, 0};
    if (seconds > 0) {
      const std::int64_t left = end - monotonic_ns();
      if (left <= 0) return;
      if (left < 1'000'000'000) pause = {0, left};
    }
    if (sigtimedwait(&interrupts, nullptr, &pause) > 0) return;
    if (!quiet) print_status(session);
  }
}

void report(const Session& session, bool json) {
  if (json) {
    std::cout << nlohmann::json{{"ticks", session.ticks()},
                                {"frames", session.frames()},
                                {"overruns", session.overruns()},
                                {"unrecorded", session.unrecorded()},
                                {"refused", session.refusals()},
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
  const sigset_t interrupts = block_interrupts();
  const auto joint = load(options.session.joint, make_progress_printer(options.json));
  if (!joint) return report_error(joint.error(), options.json);
  const auto params = make_session_params(options.session, **joint);
  if (!params) return report_error(params.error(), options.json);
  HandDevice* hand = nullptr;
  auto device = make_device(options.session, *params, **joint, &hand);
  if (!device) return report_error(device.error(), options.json);
  Session::Options session_options;
  session_options.haptic_wishes.cpu = options.session.haptic_cpu;
  session_options.recording = options.session.recording;
  session_options.share_images = !options.no_images && options.session.input == "shared-memory";
  session_options.image_segment_prefix = options.session.prefix;
  const auto session = Session::start(std::make_shared<const Scene>(*joint), *params,
                                      std::move(*device), session_options);
  if (!session) return report_error(session.error(), options.json);
  wait(**session, interrupts, options.seconds, options.json);
  for (const std::string& refused : (*session)->refusals())
    std::fprintf(stderr, "the system refused %s\n", refused.c_str());
  report(**session, options.json);
  const auto written = write_histograms(options.session.histograms, (*session)->times());
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
      "  artus serve -j meshes/simple-shoulder --input injection --seconds 10");
  add_session_options(command, options->session, "shared-memory");
  command->add_option("--seconds", options->seconds, "stop after this time; 0: when interrupted")
      ->check(number_in(0, 86400));
  command->add_flag("--no-images", options->no_images, "do not write IMAGE");
  command->add_flag("--json", options->json, "machine-readable report at the end");
  on_run(command, code, [options] { return run_serve(*options); });
}

}  // namespace artus
