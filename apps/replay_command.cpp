// SPDX-License-Identifier: AGPL-3.0-or-later
#include <array>
#include <cstdio>
#include <iostream>
#include <memory>
#include <span>

#include "artus/detail/apps/options/pose_files.h"
#include "artus/detail/apps/options/scenario_options.h"
#include "artus/detail/apps/options/session_options.h"
#include "artus/detail/core/text_file.h"
#include "artus/detail/evidence/runs/body_pictures.h"
#include "artus/detail/simulation/plain_pose.h"
#include "artus/detail/training/health/simulated_health.h"
#include "artus/echo/image_io.h"
#include "artus/session/replay.h"

namespace artus {
namespace {

struct ReplayOptions {
  JointOptions joint;
  std::string scenario;
  std::filesystem::path recording;
  TrackerFileOptions tracker;
  std::filesystem::path trace;
  std::filesystem::path frames;
  std::filesystem::path body;
  bool json = false;
};

struct TraceCloser {
  void operator()(std::FILE* file) const noexcept { std::fclose(file); }
};
using Trace = std::unique_ptr<std::FILE, TraceCloser>;

void write_numbers(std::FILE* out, std::span<const double> values) {
  for (const double value : values) std::fprintf(out, ",%.9g", value);
}

/// The plunger's columns: travel, force on the thumb, pressures, flow, volumes and status.
void write_plunger(std::FILE* out, const PlungerFeedback& p) {
  constexpr double kKilopascal = 1e3;  // Pa
  write_numbers(out, std::array{p.travel / kMillimetre, p.thumb_force, p.pressure / kKilopascal,
                                p.tip_pressure / kKilopascal, p.flow / kCubicCentimetre,
                                p.given / kCubicCentimetre, p.drawn / kCubicCentimetre});
  std::fprintf(out, ",%u", p.status);
}

/// The probe's columns: force and torque on its hand, the share of the face that presses, status,
/// and the age of the tissue.
void write_probe(std::FILE* out, const DeviceFeedback& f) {
  write_numbers(out, f.probe_force);
  write_numbers(out, f.probe_torque);
  write_numbers(out, std::array{f.probe_share});
  std::fprintf(out, ",%u,%.9g", f.probe_status, 1e3 * f.tissue_age);
}

/// A tick as a line: what was sent, its components before the guard, contact and layer, plunger,
/// probe.
void write_tick(std::FILE* out, const HapticSnapshot& s, double period, const std::string& layer) {
  std::fprintf(out, "%.6f,%llu,%.6f,%s,%s,%u,%u", static_cast<double>(s.input.tick) * period,
               static_cast<unsigned long long>(s.input.tick), s.feedback.depth / kMillimetre,
               layer.c_str(), to_string(static_cast<ContactState>(s.feedback.contact)), s.events,
               s.status);
  write_numbers(out, s.feedback.force);
  write_numbers(out, s.feedback.torque);
  write_numbers(out, s.axial);
  write_numbers(out, s.clamping_J);
  write_numbers(out, s.surface_J);
  write_numbers(out, s.workspace_J);
  write_plunger(out, s.feedback.plunger);
  write_probe(out, s.feedback);
  std::fputc('\n', out);
}

constexpr const char* kTraceHead =
    "time_s,tick,depth_mm,region,contact,events,status,force_x_n,force_y_n,force_z_n,torque_x_nm,"
    "torque_y_nm,torque_z_nm,prepuncture_n,cutting_n,attracted_n,friction_n,hard_n,clamping_x_n,"
    "clamping_y_n,clamping_z_n,surface_x_n,surface_y_n,surface_z_n,workspace_x_n,workspace_y_n,"
    "workspace_z_n,plunger_mm,thumb_n,pressure_kpa,tip_pressure_kpa,flow_ml_s,given_ml,drawn_ml,"
    "plunger_status,probe_force_x_n,probe_force_y_n,probe_force_z_n,probe_torque_x_nm,"
    "probe_torque_y_nm,probe_torque_z_nm,probe_share,probe_status,tissue_age_ms\n";

/// Measures the body of the last image, and draws it with liquid and without.
void examine(Simulation& simulation, const FrameInput& shown, const std::filesystem::path& folder,
             std::optional<BodyHealth>& health) {
  const auto question = find_health_question(simulation, shown);
  if (!question) return;
  health = measure_body_health(*question);
  if (const auto written = write_body_pictures(*question, folder, "body"); !written)
    std::fprintf(stderr, "%s\n", written.error().to_string().c_str());
}

/// `health`: takes what is found of the body; outlives the listener.
/// `images`: how many there are.
ReplayListener make_listener(const ReplayOptions& options, const CompiledJoint& joint,
                             std::size_t images, std::FILE* trace, double period,
                             std::optional<BodyHealth>& health) {
  ReplayListener listener;
  if (!options.body.empty())
    listener.on_end = [&health, folder = options.body](Simulation& simulation,
                                                       const FrameInput& shown) {
      examine(simulation, shown, folder, health);
    };
  if (trace != nullptr) {
    std::fputs(kTraceHead, trace);
    listener.on_tick = [trace, period, &joint](const HapticSnapshot& s) {
      write_tick(trace, s, period, joint.regions[s.feedback.region].name);
    };
  }
  listener.on_frame = [progress = make_progress_printer(options.json), images,
                       seen = std::size_t{0}, folder = options.frames](const FrameRecord& record,
                                                                       const Frame& frame) mutable {
    if (progress) progress("images", static_cast<double>(++seen) / static_cast<double>(images));
    if (!folder.empty()) {
      const auto file = folder / ("frame-" + std::to_string(record.input.number) + ".png");
      if (const auto written = write_image(grey_image(frame), file); !written)
        std::fprintf(stderr, "%s\n", written.error().to_string().c_str());
    }
  };
  return listener;
}

void print(const ReplayReport& r) {
  std::printf("%llu ticks, %llu different; %llu images, %llu different\n",
              static_cast<unsigned long long>(r.ticks),
              static_cast<unsigned long long>(r.different_ticks),
              static_cast<unsigned long long>(r.frames),
              static_cast<unsigned long long>(r.different_frames));
  if (r.first_different_tick)
    std::printf("first different tick %llu\n",
                static_cast<unsigned long long>(*r.first_different_tick));
  if (r.dropped > 0)
    std::printf("%llu records are missing in the recording\n",
                static_cast<unsigned long long>(r.dropped));
  if (r.empty())
    std::printf(
        "nothing was there to replay: the recording is a header alone, and proves nothing\n");
  if (!r.complete) std::printf("the recording was cut off\n");
}

nlohmann::json to_json(const ReplayReport& r) {
  return {{"ticks", r.ticks},     {"different_ticks", r.different_ticks},
          {"frames", r.frames},   {"different_frames", r.different_frames},
          {"dropped", r.dropped}, {"complete", r.complete},
          {"empty", r.empty()},   {"identical", r.identical()}};
}

/// The body of the scenario, or of the joint that is named.
Result<std::shared_ptr<const Scene>> find_body(const ReplayOptions& options) {
  const Progress progress = make_progress_printer(options.json);
  if (!options.scenario.empty()) {
    const auto scenario = find_scenario(options.scenario);
    ARTUS_TRY(scenario);
    return load_scene(*scenario, options.joint.joint, progress);
  }
  if (options.joint.joint.empty())
    return fail(ErrorCode::malformed, "name the joint, or the scenario that was tried", "--joint");
  const auto joint = load(options.joint, progress);
  ARTUS_TRY(joint);
  return std::make_shared<const Scene>(*joint);
}

ExitCode run_replay(const ReplayOptions& options) {
  const auto body = find_body(options);
  if (!body) return report_error(body.error(), options.json);
  const std::shared_ptr<const Scene>& scene = *body;
  const auto recording = read_any_recording(options.recording, scene, options.tracker);
  if (!recording) return report_error(recording.error(), options.json);
  Trace trace;
  if (!options.trace.empty()) {
    trace.reset(std::fopen(options.trace.c_str(), "w"));
    if (!trace)
      return report_error({ErrorCode::unreadable, "cannot write the trace", options.trace},
                          options.json);
  }
  if (!options.frames.empty())
    if (const auto made = make_folder(options.frames); !made)
      return report_error(made.error(), options.json);
  const double period = 1 / recording->head.params.haptic_rate;
  std::optional<BodyHealth> health;
  const auto report = replay(*recording, scene,
                             make_listener(options, scene->joint(), recording->frames.size(),
                                           trace.get(), period, health));
  if (!report) return report_error(report.error(), options.json);
  if (options.json) {
    nlohmann::json all = to_json(*report);
    if (!options.body.empty()) all["body"] = health ? to_json(*health) : nlohmann::json();
    std::cout << all.dump(2) << '\n';
  } else {
    print(*report);
    if (health) std::printf("the body in the end:\n%s", to_text(*health).c_str());
  }
  const bool whole = !health || health->sound();
  return report->identical() && whole ? ExitCode::ok : ExitCode::failed;
}

}  // namespace

void add_replay_command(Command& app, ExitCode& code) {
  auto options = std::make_shared<ReplayOptions>();
  Command* command = add_command(
      app, "replay", "Run a recorded session again and compare every force and image",
      "Exit code 1 when a force or an image is not the same bytes, or there is none, or when\n"
      "--body finds the body broken. A list of poses, or a tracker's sequence, is run as a "
      "session\n"
      "first.\n"
      "Examples:\n"
      "  artus replay session.rec -j meshes/simple-shoulder\n"
      "  artus replay attempts/ID/session.rec --scenario gel-find\n"
      "  artus replay session.rec -j real.artus --trace forces.csv --frames out/frames\n"
      "  artus replay tracked.igs.mha -j real.artus --trace forces.csv");
  command
      ->add_option("recording", options->recording,
                   "file of --record, or poses (a list, a tracker's file) that lead a session")
      ->required();
  add_tracker_file_options(command, options->tracker);
  add_joint_options(command, options->joint);
  command->get_option("--joint")->required(false);
  command->add_option("--scenario", options->scenario,
                      "of which the recording is an attempt: its body, in place of a joint");
  command->add_option("--trace", options->trace,
                      "write forces, their components, contact, layer and plunger as CSV");
  command->add_option("--frames", options->frames, "write the images as PNG into this folder");
  command->add_option("--body", options->body,
                      "folder for pictures of the body in the end, with liquid and without, which "
                      "are compared");
  command->add_flag("--json", options->json, "machine-readable output");
  on_run(command, code, [options] { return run_replay(*options); });
}

}  // namespace artus
