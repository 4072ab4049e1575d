// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <iostream>
#include <memory>
#include <string>
#include <utility>

#include "artus/dataset/sweep.h"
#include "artus/detail/apps/options/pose_files.h"
#include "artus/detail/apps/options/press_options.h"
#include "artus/detail/core/noise.h"
#include "artus/detail/dataset/pose_draw.h"
#include "artus/detail/dataset/shards.h"
#include "artus/detail/exchange/line_file.h"
#include "artus/echo/transducer_file.h"

namespace artus {
namespace {

struct SweepCommandOptions : PoseListOptions {
  std::filesystem::path out;
  std::string shard;
  std::string frames;
  int frames_per_shard = 1000;
  std::int64_t draw = 0;
  std::filesystem::path ranges;
  std::string truth{kSweepTruthNames[0]};
  std::string rf;
  bool restart = false;
};

Result<SweepOptions> sweep_options_of(const SweepCommandOptions& options,
                                      const LoadedView& loaded) {
  SweepOptions sweep;
  sweep.transducer = loaded.view.transducer;
  sweep.settings = loaded.view.settings;
  sweep.needle = loaded.view.needle_shape;
  const auto named = std::find(kSweepTruthNames.begin(), kSweepTruthNames.end(), options.truth);
  sweep.truth = static_cast<SweepTruth>(named - kSweepTruthNames.begin());
  sweep.restart = options.restart;
  if (!options.rf.empty()) {
    const auto file = line_file_of(options.rf, "--rf");
    ARTUS_TRY(file);
    sweep.rf = *file;
  }
  return sweep;
}

/// What one shard after the other makes of the flags.
Result<ShardJob> job_of(const SweepCommandOptions& options) {
  if (!options.shard.empty()) return parse_turn(options.shard, "--shard");
  if (!options.frames.empty()) return parse_frames(options.frames, "--frames");
  return ShardJob{};
}

/// Whether every probe that may be drawn can press.
Result<void> check_faces(const SweepOptions& sweep) {
  for (const TransducerPreset& preset : sweep.transducers)
    ARTUS_TRY(pressing_face_at(preset.transducer, "--ranges " + preset.name));
  if (sweep.transducers.empty()) ARTUS_TRY(pressing_face_at(sweep.transducer, "--transducer"));
  return {};
}

/// Loads the joints and probes that the ranges name into `sweep`; probes under the same flags.
Result<void> load_drawn(const SweepCommandOptions& options, const DrawRanges& ranges,
                        SweepOptions& sweep) {
  for (const std::string& name : ranges.transducers) {
    ViewOptions view = options.view;
    view.transducer = name;
    const auto made = make_view(view);
    ARTUS_TRY(made);
    const auto preset = find_transducer(name);
    ARTUS_TRY(preset);
    sweep.transducers.push_back(*preset);
    sweep.transducers.back().transducer = made->transducer;
  }
  for (const std::filesystem::path& file : ranges.joints) {
    JointOptions patient = options.joint;
    patient.joint = file;
    const auto joint = load(patient, make_progress_printer(options.json));
    ARTUS_TRY(joint);
    sweep.patients.push_back(std::make_shared<const Scene>(*joint));
  }
  for (std::size_t i = 0; i < ranges.drawn_patients; ++i) {
    constexpr std::uint64_t kSeeds = 1'000'000'000;
    JointOptions patient = options.joint;
    patient.patient = "seed=" + std::to_string(mix_bits(mix_bits(options.view.seed) ^ i) % kSeeds);
    const auto joint = load(patient, make_progress_printer(options.json));
    ARTUS_TRY(joint);
    sweep.patients.push_back(std::make_shared<const Scene>(*joint));
  }
  return {};
}

/// The frames that the flags ask for; `sweep` gets what drawn ones need besides.
Result<FrameSource> frames_of(const SweepCommandOptions& options, const LoadedView& loaded,
                              SweepOptions& sweep) {
  if (options.draw == 0) {
    auto poses = read_any_poses(options.poses, options.tracker);
    ARTUS_TRY(poses);
    return source_of(std::move(*poses));
  }
  auto ranges =
      options.ranges.empty() ? Result<DrawRanges>(DrawRanges()) : read_draw_ranges(options.ranges);
  ARTUS_TRY(ranges);
  ARTUS_TRY(load_drawn(options, *ranges, sweep));
  DrawBase base{{loaded.scene}, sweep.needle, {sweep.transducer}, sweep.settings};
  if (!sweep.transducers.empty()) base.transducers.clear();
  for (const TransducerPreset& preset : sweep.transducers)
    base.transducers.push_back(preset.transducer);
  base.patients.insert(base.patients.end(), sweep.patients.begin(), sweep.patients.end());
  for (const auto& patient : base.patients)
    if (ranges->press_share > 0 && patient->joint().mesh.tetrahedra.empty())
      return fail(ErrorCode::invalid, "a joint without tetrahedra cannot be pressed",
                  patient->joint().name);
  if (ranges->press_share > 0) ARTUS_TRY(check_faces(sweep));
  if (ranges->not_in != DrawRanges().not_in)  // not every joint has what is barred by itself
    for (const std::string& name : unknown_places(base, *ranges))
      return fail(ErrorCode::not_found, "no tissue or structure has this name in not_in",
                  options.ranges.string() + ": " + name);
  return drawn_frames(base, *ranges, options.view.seed, static_cast<std::size_t>(options.draw));
}

ExitCode run_shards(const SweepCommandOptions& options) {
  const auto job = job_of(options);
  if (!job) return report_error(job.error(), options.json);
  const auto loaded = load_view(options.joint, options.view, options.json);
  if (!loaded) return report_error(loaded.error(), options.json);
  ShardOptions shard_options;
  const auto sweep = sweep_options_of(options, *loaded);
  if (!sweep) return report_error(sweep.error(), options.json);
  shard_options.sweep = *sweep;
  const auto source = frames_of(options, *loaded, shard_options.sweep);
  if (!source) return report_error(source.error(), options.json);
  shard_options.frames = static_cast<std::size_t>(options.frames_per_shard);
  shard_options.engine = ARTUS_VERSION;
  const auto begin = std::chrono::steady_clock::now();
  const auto result = write_shards(loaded->scene, *source, *job, options.out, shard_options,
                                   make_progress_printer(options.json));
  if (!result) return report_error(result.error(), options.json);
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  const auto frames = static_cast<double>(result->frames);
  if (options.json)
    std::cout << nlohmann::json{{"shards", result->shards}, {"found", result->found},
                                {"drawn", result->drawn},   {"frames", result->frames},
                                {"bytes", result->bytes},   {"seconds", seconds}}
                     .dump(2)
              << '\n';
  else
    std::printf("%zu shards: %zu were there, %zu drawn in %s; %.1f frames/s, %.0f bytes a frame\n",
                result->shards, result->found, result->drawn, options.out.c_str(), frames / seconds,
                frames > 0 ? static_cast<double>(result->bytes) / frames : 0);
  return ExitCode::ok;
}

ExitCode run_sweep_command(const SweepCommandOptions& options) {
  if (options.poses.empty() == (options.draw == 0))
    return report_error({ErrorCode::invalid, "give either a list of poses or --draw", "--poses"},
                        options.json);
  if (options.draw > 0 || !options.shard.empty() || !options.frames.empty())
    return run_shards(options);
  const auto poses = read_any_poses(options.poses, options.tracker);
  if (!poses) return report_error(poses.error(), options.json);
  const auto loaded = load_view(options.joint, options.view, options.json);
  if (!loaded) return report_error(loaded.error(), options.json);
  const auto sweep = sweep_options_of(options, *loaded);
  if (!sweep) return report_error(sweep.error(), options.json);
  const auto result =
      run_sweep(loaded->scene, *poses, options.out, *sweep, make_progress_printer(options.json));
  if (!result) return report_error(result.error(), options.json);
  if (options.json) {
    std::cout << nlohmann::json{{"joint", loaded->joint().name},
                                {"folder", options.out.string()},
                                {"poses", result->poses},
                                {"found", result->found},
                                {"drawn", result->drawn},
                                {"off_skin", result->off_skin},
                                {"partly_off_skin", result->partly_off}}
                     .dump(2)
              << '\n';
  } else {
    std::printf("%zu poses: %zu were there, %zu drawn; truth.jsonl and frames/ in %s\n",
                result->poses, result->found, result->drawn, options.out.c_str());
    if (result->off_skin > 0)
      std::printf("! in %zu of them no part of the probe touches skin: they are black\n",
                  result->off_skin);
    if (result->partly_off > 0)
      std::printf(
          "! in %zu of them some of the face is off the skin: those columns are black "
          "(contact.lifted_lines in truth.jsonl)\n",
          result->partly_off);
  }
  return ExitCode::ok;
}

void add_shard_options(Command* command, SweepCommandOptions& options) {
  command
      ->add_option("--shard", options.shard,
                   "k/N: draw every N-th tar shard, from the k-th (0 to N-1); one job of N")
      ->group("Shards");
  command
      ->add_option("--frames", options.frames,
                   "a:b: draw the shards of frames a to b-1, whole shards alone")
      ->group("Shards");
  command->add_option("--frames-per-shard", options.frames_per_shard, "the same for all jobs")
      ->check(whole_number_in(1, 1000000))
      ->group("Shards")
      ->capture_default_str();
  command
      ->add_option("--draw", options.draw,
                   "draw so many poses at random, by --seed, in place of a list")
      ->check(whole_number_in(1, 1000000000000))
      ->group("Shards");
  command->add_option("--ranges", options.ranges, "what drawn frames spread over (.toml)")
      ->group("Shards");
}

}  // namespace

void add_sweep_command(Command& app, ExitCode& code) {
  auto options = std::make_shared<SweepCommandOptions>();
  Command* command = add_command(
      app, "sweep", "Many poses from a file: images, labels, masks and a line of truth for each",
      "A pose is a line of JSON, {\"probe\": {\"position_mm\": [x,y,z], \"direction\": [x,y,z],\n"
      "\"lateral\": [x,y,z]}, \"needle\": {\"entry_mm\": [x,y,z], \"tip_mm\": [x,y,z]}}, or a line "
      "of\n"
      "CSV under a header (docs/echography.md). A sweep that was stopped continues where it was.\n"
      "Examples:\n"
      "  artus sweep -j shoulder.artus --poses poses.jsonl --out out/sweep\n"
      "  artus sweep -j shoulder.artus --poses poses.csv --transducer linear-4-9 --depth 50 "
      "--out out/deep\n"
      "  artus sweep -j shoulder.artus --draw 1000000 --seed 7 --shard 3/64 --out out/set\n"
      "(docs/datasets.md)");
  add_pose_list_options(command, *options);
  add_shard_options(command, *options);
  command->add_option("-o,--out", options->out, "folder for the results")->required();
  command
      ->add_option("--truth", options->truth,
                   "labels and masks where the picture shows things, where they truly are, or both")
      ->one_of({"shown", "true", "both"})
      ->capture_default_str();
  command
      ->add_option("--rf", options->rf,
                   "also write each frame's beamformed lines before the envelope (docs/rf.md)")
      ->one_of({"npz", "uff"});
  command->add_flag("--restart", options->restart, "throw away an earlier sweep of the folder");
  on_run(command, code, [options] { return run_sweep_command(*options); });
}

}  // namespace artus
