// SPDX-License-Identifier: AGPL-3.0-or-later
#include <atomic>
#include <cstdio>
#include <iostream>
#include <memory>
#include <thread>
#include <vector>

#include "artus/detail/anatomy/body/layered_body.h"
#include "artus/detail/apps/options/hand_options.h"
#include "artus/detail/apps/options/interrupts.h"
#include "artus/detail/apps/options/session_options.h"
#include "artus/detail/session/injecting_device.h"
#include "artus/detail/session/servo_loop.h"

namespace artus {
namespace {

struct LoopOptions {
  JointOptions joint;
  std::string device = "virtuose_6d_desktop";
  ServoOptions servo;
  FeelOptions feel;
  double speed_mm_s = 15;
  bool json = false;
};

/// Six tissues of the library as spheres in one another, shoulder-sized, 120,000 triangles: what
/// the loop runs on when no joint is named.
Result<std::shared_ptr<const CompiledJoint>> make_ball() {
  auto tissues = read_bundled_tissues();
  ARTUS_TRY(tissues);
  const std::vector<SphereLayer> layers{{"skin", 0.060},   {"muscle", 0.057},    {"bursa", 0.042},
                                        {"tendon", 0.039}, {"cartilage", 0.033}, {"bone", 0.030}};
  CompiledJoint joint = make_nested_spheres(*tissues, layers, Vec3(0, 0, 0.060), 5);
  joint.injections.push_back({"to the centre", Vec3::Zero(), Vec3(0, 0, 0.020)});
  return std::make_shared<const CompiledJoint>(std::move(joint));
}

/// The first planned injection, else along the joint's default needle, 10 mm beyond bone if need
/// be.
InjectionPlan make_plan(const CompiledJoint& joint, double speed_mm_s) {
  InjectionPlan plan;
  plan.X_WP = joint.X_JP_default;
  plan.speed = speed_mm_s * kMillimetre;
  plan.entry_W = joint.X_JN_default.translation();
  plan.direction_W = joint.X_JN_default.linear().col(2);
  if (!joint.injections.empty()) {
    const PlannedInjection& first = joint.injections.front();
    plan.entry_W = first.entry;
    plan.direction_W = (first.target - first.entry).normalized();
    plan.target = (first.target - first.entry).norm();
  }
  plan.deepest = plan.target + 20 * kMillimetre;
  return plan;
}

/// The histogram in powers of two, for people.
void print_histogram(const char* what, const LatencyHistogram& h) {
  std::printf("\n%s, us\n", what);
  const auto count = static_cast<double>(h.count());
  double edge = 0.25;
  std::uint64_t below = 0;
  int bin = 0;
  while (below < h.count()) {
    std::uint64_t here = 0;
    for (; bin < LatencyHistogram::kBins && 1e-3 * LatencyHistogram::upper_edge(bin) <= edge; ++bin)
      here += h.bin(bin);
    below += here;
    if (here > 0) {
      const double share = static_cast<double>(here) / count;
      const std::string bar(static_cast<std::size_t>(50 * share), '#');
      std::printf("  up to %10.2f %11llu %8.4f %% %s\n", edge,
                  static_cast<unsigned long long>(here), 100 * share, bar.c_str());
    }
    if (bin >= LatencyHistogram::kBins) break;
    edge *= 2;
  }
}

nlohmann::json to_json_us(const LatencyHistogram& h) {
  nlohmann::json bins = nlohmann::json::array();
  for (int i = 0; i < LatencyHistogram::kBins; ++i) {
    if (h.bin(i) > 0) bins.push_back({1e-3 * LatencyHistogram::upper_edge(i), h.bin(i)});
  }
  return {{"count", h.count()},
          {"p50_us", h.percentile_us(0.5)},
          {"p99_us", h.percentile_us(0.99)},
          {"p999_us", h.percentile_us(0.999)},
          {"max_us", h.max_us()},
          {"bins_up_to_us_count", bins}};
}

void print_report(const ServoReport& r, const ServoOptions& options) {
  std::printf("%-18s %10s %9s %9s %9s %9s %9s\n", "us", "count", "p50", "p95", "p99", "p99.9",
              "max");
  print_line("compute", r.compute);
  print_line("processor time", r.cpu);
  print_line("lateness", r.lateness);
  print_line("lateness, no work", r.floor);
  print_line("a fixed work", r.fixed);
  print_histogram("compute", r.compute);
  print_histogram("lateness", r.lateness);
  std::printf("\n%llu ticks of %.1f us, %llu late by a period or more, %llu at rest since late\n",
              static_cast<unsigned long long>(r.ticks), 1e6 / options.rate_hz,
              static_cast<unsigned long long>(r.overruns),
              static_cast<unsigned long long>(r.rested));
  std::printf(
      "needle in the body %.0f %%, on bone %.0f %% of the ticks, %llu refused, up to %.2f N\n",
      100.0 * static_cast<double>(r.inserted) / static_cast<double>(r.ticks),
      100.0 * static_cast<double>(r.on_bone) / static_cast<double>(r.ticks),
      static_cast<unsigned long long>(r.faults), r.max_force);
  for (const std::string& refused : r.refused)
    std::printf("the system refused: %s\n", refused.c_str());
}

nlohmann::json to_json(const ServoReport& r, const ServoOptions& options,
                       const std::string& joint) {
  return {{"joint", joint},
          {"rate_hz", options.rate_hz},
          {"ticks", r.ticks},
          {"overruns", r.overruns},
          {"rested", r.rested},
          {"faults", r.faults},
          {"inserted", r.inserted},
          {"on_bone", r.on_bone},
          {"most_force_n", r.max_force},
          {"refused", r.refused},
          {"compute", to_json_us(r.compute)},
          {"cpu", to_json_us(r.cpu)},
          {"lateness", to_json_us(r.lateness)},
          {"lateness_floor", to_json_us(r.floor)},
          {"fixed_work", to_json_us(r.fixed)}};
}

ExitCode run_loop(const LoopOptions& options) {
  const auto joint = options.joint.joint.empty()
                         ? make_ball()
                         : load(options.joint, make_progress_printer(options.json));
  if (!joint) return report_error(joint.error(), options.json);
  const auto device = find_device(options.device);
  if (!device) return report_error(device.error(), options.json);
  SessionParams params;
  params.device = *device;
  params.haptic_rate = options.servo.rate_hz;
  const auto feel = make_feel(options.feel, **joint);
  if (!feel) return report_error(feel.error(), options.json);
  params.feel = *feel;
  if (const auto valid = validate(params); !valid) return report_error(valid.error(), options.json);
  Simulation simulation(std::make_shared<const Scene>(*joint), params);
  InjectingDevice hand(make_plan(**joint, options.speed_mm_s), *device, options.servo.rate_hz);
  Interrupts interrupts;
  std::atomic<bool> stop{false};
  std::atomic<bool> over{false};
  std::thread waiting([&] {
    while (!over && !stop) stop = interrupts.wait(0.1);
  });
  Seqlock<HapticSnapshot> newest;
  const auto report = std::make_unique<ServoReport>();
  run_servo_loop(simulation, hand, options.servo, stop, newest, *report);
  over = true;
  waiting.join();
  if (options.json)
    std::cout << to_json(*report, options.servo, (*joint)->name).dump(2) << '\n';
  else
    print_report(*report, options.servo);
  return ExitCode::ok;
}

}  // namespace

void add_loop_command(Command& app, ExitCode& code) {
  auto options = std::make_shared<LoopOptions>();
  Command* command = add_command(
      app, "loop", "Run the haptic servo loop alone and print where its time goes",
      "A simulated hand injects again and again, closed loop. Prints histograms of compute time\n"
      "and lateness, the lateness of ticks that do nothing beside them, and what the system\n"
      "refused (SCHED_FIFO, locked memory, a processor of its own). 'A fixed work' is arithmetic\n"
      "of constant length after each tick: what its time spreads is the machine's.\n"
      "Examples:\n"
      "  artus loop --seconds 60 --rate 10000\n"
      "  artus loop --seconds 10 --rate 1000 -j meshes/simple-shoulder --cpu 1 --json");
  add_joint_options(command, options->joint);
  command->get_option("--joint")->required(false)->description(
      "joint folder or compiled file; without it: six tissues as spheres in one another");
  command->add_option("--seconds", options->servo.seconds, "how long")
      ->check(number_in(0.01, 86400))
      ->capture_default_str();
  add_haptic_rate_option(command, options->servo.rate_hz, "--rate,--haptic-rate");
  add_device_option(command, options->device);
  command->add_option("--speed-mm-s", options->speed_mm_s, "of the simulated hand")
      ->check(number_in(0.1, 200))
      ->capture_default_str();
  command->add_option("--cpu", options->servo.thread.cpu, "processor to run on; -1: any")
      ->check(whole_number_in(-1, 1023))
      ->capture_default_str();
  command
      ->add_option("--priority", options->servo.thread.fifo_priority,
                   "SCHED_FIFO priority to ask for; 0: none")
      ->check(whole_number_in(0, 99))
      ->capture_default_str();
  add_feel_options(command, options->feel);
  add_needle_length_option(command, options->feel.needle_length_mm);
  command->add_flag("--json", options->json, "machine-readable report");
  on_run(command, code, [options] { return run_loop(*options); });
}

}  // namespace artus
