// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/apps/options/session_options.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <sstream>
#include <utility>

#include "artus/detail/anatomy/body/holders.h"
#include "artus/detail/apps/options/hand_options.h"
#include "artus/detail/core/text_file.h"
#include "artus/detail/core/units.h"
#include "artus/detail/session/injecting_device.h"
#include "artus/detail/session/record/recorded_device.h"
#include "artus/session/shared_memory_device.h"

namespace artus {
namespace {

constexpr double kUsToMs = 1e-3;

std::vector<DeviceSample> samples_of(const Recording& recording) {
  std::vector<DeviceSample> samples;
  samples.reserve(recording.ticks.size());
  for (const TickRecord& tick : recording.ticks) samples.push_back(tick.input.device);
  return samples;
}

Result<std::unique_ptr<InputDevice>> make_injection_device(const SessionOptions& options,
                                                           const SessionParams& params,
                                                           const CompiledJoint& joint) {
  constexpr double kBeyond = 20e-3;  // m past the target where bone is looked for
  const auto chosen = chosen_injection(options, joint);
  ARTUS_TRY(chosen);
  if (!*chosen)
    return fail(ErrorCode::not_found, "the joint plans no injection: give --entry and --target",
                "--injection");
  const PlannedInjection& plan = **chosen;
  const Vec3 direction = plan.target - plan.entry;
  InjectionPlan injection;
  injection.entry_W = plan.entry;
  injection.direction_W = direction.normalized();
  injection.X_WP = joint.X_JP_default;
  injection.target = direction.norm();
  injection.deepest = direction.norm() + kBeyond;
  injection.speed = options.speed_mm_s * kMillimetre;
  injection.volume = options.give_ml * kCubicCentimetre;
  const auto plunger = make_plunger_params(params.syringe, needle_length_of(params));
  ARTUS_TRY(plunger);
  injection.plunger = *plunger;
  return std::make_unique<InjectingDevice>(injection, params.device, params.haptic_rate);
}

nlohmann::json to_json(const LatencyHistogram& h) {
  return {{"count", h.count()},
          {"p50_ms", kUsToMs * h.percentile_us(0.5)},
          {"p95_ms", kUsToMs * h.percentile_us(0.95)},
          {"p99_ms", kUsToMs * h.percentile_us(0.99)},
          {"p999_ms", kUsToMs * h.percentile_us(0.999)},
          {"max_ms", kUsToMs * h.max_us()}};
}

}  // namespace

void add_prefix_option(Command* command, std::string& prefix) {
  command
      ->add_option("--prefix", prefix,
                   "prefix of the names POS, POS-PROBE, FORCE and IMAGE in shared memory")
      ->check(FlagCheck{[](const std::string& text) {
                          const bool good = artus_shm_is_prefix(text.c_str()) != 0;
                          return good ? std::string()
                                      : "at most 63 letters, digits, '-', '_' and '.'";
                        },
                        "a name"});
}

void add_session_options(Command* command, SessionOptions& options,
                         const std::string& default_input) {
  options.input = default_input;
  add_joint_options(command, options.joint);
  add_feel_options(command, options.feel);
  add_needle_length_option(command, options.feel.needle_length_mm);
  add_device_option(command, options.device);
  add_own_device_options(command, options.own_device);
  add_haptic_rate_option(command, options.haptic_rate, "--haptic-rate,--rate");
  command->add_option("--image-rate", options.image_rate, "images a second, Hz")
      ->check(number_in(1, 120))
      ->capture_default_str();
  command
      ->add_option(
          "--input", options.input,
          "shared-memory, hand (mouse, keyboard, gamepad), injection (a simulated hand does a "
          "planned one again and again), igtl (a tracker, see --igtl), or a recording")
      ->capture_default_str();
  add_prefix_option(command, options.prefix);
  command->add_option("--record", options.recording, "keep all inputs in this file");
  add_plan_options(command, options.plan);
  command->add_option("--injection", options.injection, "which planned injection, from 1")
      ->capture_default_str();
  command->add_option("--speed-mm-s", options.speed_mm_s, "of the simulated hand")
      ->check(number_in(0.1, 200))
      ->capture_default_str();
  command->add_option("--give-ml", options.give_ml, "ml that the simulated hand injects each time")
      ->check(number_in(0, 50))
      ->capture_default_str();
  command
      ->add_option("--syringe-ml", options.syringe_ml,
                   "ml in the syringe, for a plunger to push out")
      ->check(number_in(0.1, 50))
      ->capture_default_str();
  add_gauge_option(command, options.gauge);
  command->add_option("--liquid", options.liquid, "in the syringe, of meshes/liquids.toml")
      ->capture_default_str();
  command
      ->add_option("--haptic-cpu,--cpu", options.haptic_cpu,
                   "processor of the haptic thread; -1: any")
      ->check(whole_number_in(-1, 1023))
      ->capture_default_str();
  command
      ->add_option("--haptic-priority,--priority", options.haptic_priority,
                   "SCHED_FIFO priority to ask for the haptic thread; 0: none")
      ->check(whole_number_in(0, 99))
      ->capture_default_str();
  command->add_option("--histograms", options.histograms,
                      "write where the time went as CSV, bin by bin");
  add_threads_option(command, options.threads);
  add_rigid_option(command, options.rigid);
  add_igtl_options(command, options.igtl);
}

void add_rigid_option(Command* command, bool& rigid) {
  command->add_flag(
      "--rigid", rigid,
      "tissue does not give way to probe and needle; by default it does, in the picture and "
      "in both hands, and the first image comes some seconds later");
}

Result<SessionParams> make_session_params(const SessionOptions& options,
                                          const CompiledJoint& joint) {
  SessionParams params;
  const auto shape = needle_of_flag(options.gauge);
  ARTUS_TRY(shape);
  params.needle_shape = *shape;
  params.syringe.gauge = options.gauge;
  params.syringe.filled = options.syringe_ml * kCubicCentimetre;
  params.syringe.liquid = options.liquid;
  const auto device = chosen_device(options.device, options.own_device);
  ARTUS_TRY(device);
  params.device = *device;
  params.haptic_rate = options.haptic_rate;
  params.image_rate = options.image_rate;
  params.image.n_threads = options.threads;
  if (options.input == "igtl") {      // a pose that is held is not stale
    constexpr double kMargin = 5e-3;  // s
    params.guard.stale_after =
        std::max(params.guard.stale_after, 1e-3 * options.igtl.needle_hold_ms + kMargin);
  }
  params.deform = !options.rigid;
  if (params.deform && !joint.mesh.tetrahedra.empty() && !find_holders(joint).any())
    return fail(ErrorCode::invalid, explain_unheld() + "; or run it with --rigid", joint.name);
  const auto feel = make_feel(options.feel, joint);
  ARTUS_TRY(feel);
  params.feel = *feel;
  const auto plan = chosen_injection(options, joint);
  ARTUS_TRY(plan);
  if (*plan) {
    params.gesture.p_W = (*plan)->entry;
    params.gesture.axis_W = ((*plan)->target - (*plan)->entry).normalized();
  }
  if (!options.igtl.calibration.empty()) {
    const auto calibration = read_tracker_calibration(options.igtl.calibration);
    ARTUS_TRY(calibration);
    if (calibration->insertion) params.gesture = *calibration->insertion;
  }
  ARTUS_TRY(validate(params));
  return params;
}

Result<std::optional<PlannedInjection>> chosen_injection(const SessionOptions& options,
                                                         const CompiledJoint& joint) {
  const auto plans = make_plan(options.plan, joint);
  ARTUS_TRY(plans);
  if (plans->empty() && options.injection == 1) return std::optional<PlannedInjection>();
  const auto i = static_cast<std::size_t>(options.injection - 1);
  if (options.injection < 1 || i >= plans->size())
    return fail(ErrorCode::not_found,
                "there is no injection " + std::to_string(options.injection) +
                    ": the joint plans " + std::to_string(plans->size()) + ", counted from 1",
                "--injection");
  return std::optional<PlannedInjection>((*plans)[i]);
}

Session::Options make_thread_options(const SessionOptions& options) {
  Session::Options made;
  made.haptic_options.cpu = options.haptic_cpu;
  made.haptic_options.fifo_priority = options.haptic_priority;
  made.recording = options.recording;
  made.image_segment_prefix = options.prefix;
  return made;
}

HandTarget first_target(const CompiledJoint& joint, const std::optional<PlannedInjection>& plan) {
  constexpr double kAbove = 10e-3;  // m off the skin
  HandTarget target;
  target.X_WP = to_plain(joint.X_JP_default);
  Pose X_JN = joint.X_JN_default;
  if (plan) {
    const Vec3 axis = (plan->target - plan->entry).normalized();
    X_JN = make_pose(plan->entry - kAbove * axis, axis, joint.X_JP_default.linear().col(1));
  }
  target.X_WN = to_plain(X_JN);
  return target;
}

Result<std::unique_ptr<InputDevice>> make_device(const SessionOptions& options,
                                                 const SessionParams& params,
                                                 const CompiledJoint& joint,
                                                 const TrackerInput& tracker, HandDevice** hand) {
  *hand = nullptr;
  if (options.input == "igtl") return make_tracker_device(options.igtl, tracker);
  if (options.input == "shared-memory") {
    std::vector<std::string> names;
    for (const Region& region : joint.regions) names.push_back(region.name);
    auto device = SharedMemoryDevice::open(options.prefix, std::move(names));
    ARTUS_TRY(device);
    return std::unique_ptr<InputDevice>(std::move(*device));
  }
  if (options.input == "hand") {
    const auto plan = chosen_injection(options, joint);
    ARTUS_TRY(plan);
    auto device = std::make_unique<HandDevice>(first_target(joint, *plan), 1 / params.haptic_rate);
    *hand = device.get();
    return std::unique_ptr<InputDevice>(std::move(device));
  }
  if (options.input == "injection") return make_injection_device(options, params, joint);
  std::error_code ignored;
  if (!std::filesystem::exists(options.input, ignored))
    return fail(ErrorCode::not_found,
                "'" + options.input +
                    "' is neither shared-memory, hand, injection or igtl nor a recording's file",
                "--input");
  const auto recording = read_recording(options.input);
  ARTUS_TRY(recording);
  return std::unique_ptr<InputDevice>(std::make_unique<RecordedDevice>(samples_of(*recording)));
}

void print_line(const char* what, const LatencyHistogram& h) {
  std::printf("%-18s %10llu %9.1f %9.1f %9.1f %9.1f %9.1f\n", what,
              static_cast<unsigned long long>(h.count()), h.percentile_us(0.5),
              h.percentile_us(0.95), h.percentile_us(0.99), h.percentile_us(0.999), h.max_us());
}

void print_times(const SessionTimes& times, const SessionParams& params) {
  std::printf("%-18s %10s %9s %9s %9s %9s %9s\n", "us", "count", "p50", "p95", "p99", "p99.9",
              "max");
  print_line("haptic compute", times.haptic_compute);
  print_line("haptic processor", times.haptic_cpu);
  print_line("haptic lateness", times.haptic_lateness);
  if (times.tissue_age.count() > 0) print_line("age of the tissue felt", times.tissue_age);
  if (times.haptic_floor.count() > 0) print_line("late without work", times.haptic_floor);
  if (times.haptic_fixed.count() > 0) print_line("fixed work, haptic", times.haptic_fixed);
  if (times.tissue_step.count() > 0) {
    print_line("tissue step", times.tissue_step);
    print_line("tissue interval", times.tissue_interval);
  }
  if (times.image_render.count() > 0) {
    print_line("image render", times.image_render);
    print_line("image interval", times.image_interval);
    print_line("thirty images", times.image_thirty);
    print_line("pose to image", times.pose_to_image);
  }
  if (times.fixed_work.count() > 0) print_line("a fixed work", times.fixed_work);
  std::printf("haptic period %.0f us, image period %.0f us\n", 1e6 / params.haptic_rate,
              1e6 / params.image_rate);
}

Result<void> write_histograms(const std::filesystem::path& file, const SessionTimes& times) {
  if (file.empty()) return {};
  const std::array<std::pair<const char*, const LatencyHistogram*>, 11> columns{
      {{"haptic_compute", &times.haptic_compute},
       {"haptic_processor", &times.haptic_cpu},
       {"haptic_lateness", &times.haptic_lateness},
       {"haptic_floor", &times.haptic_floor},
       {"haptic_fixed_work", &times.haptic_fixed},
       {"tissue_step", &times.tissue_step},
       {"tissue_interval", &times.tissue_interval},
       {"image_render", &times.image_render},
       {"image_interval", &times.image_interval},
       {"pose_to_image", &times.pose_to_image},
       {"fixed_work", &times.fixed_work}}};
  std::ostringstream out;
  out << "upper_edge_us";
  for (const auto& [name, histogram] : columns) out << ',' << name;
  out << '\n';
  for (int i = 0; i < LatencyHistogram::kBins; ++i) {
    const bool empty = std::all_of(columns.begin(), columns.end(),
                                   [i](const auto& c) { return c.second->bin(i) == 0; });
    if (empty) continue;
    out << 1e-3 * LatencyHistogram::upper_edge(i);
    for (const auto& [name, histogram] : columns) out << ',' << histogram->bin(i);
    out << '\n';
  }
  return write_text(file, out.str());
}

nlohmann::json to_json(const SessionTimes& times) {
  return {{"haptic_compute", to_json(times.haptic_compute)},
          {"haptic_cpu", to_json(times.haptic_cpu)},
          {"haptic_lateness", to_json(times.haptic_lateness)},
          {"tissue_age", to_json(times.tissue_age)},
          {"haptic_floor", to_json(times.haptic_floor)},
          {"haptic_fixed_work", to_json(times.haptic_fixed)},
          {"tissue_step", to_json(times.tissue_step)},
          {"tissue_interval", to_json(times.tissue_interval)},
          {"image_render", to_json(times.image_render)},
          {"image_interval", to_json(times.image_interval)},
          {"image_thirty", to_json(times.image_thirty)},
          {"pose_to_image", to_json(times.pose_to_image)},
          {"fixed_work", to_json(times.fixed_work)}};
}

}  // namespace artus
