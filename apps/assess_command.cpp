// SPDX-License-Identifier: AGPL-3.0-or-later
#include <cstdio>
#include <iostream>
#include <memory>
#include <utility>

#include "artus/detail/anatomy/surfaces/repair.h"
#include "artus/detail/anatomy/surfaces/surface_io.h"
#include "artus/detail/apps/commands.h"
#include "artus/detail/apps/options/arguments.h"
#include "artus/detail/apps/options/pose_files.h"
#include "artus/detail/apps/options/scenario_options.h"
#include "artus/detail/apps/options/view_options.h"
#include "artus/detail/core/text_file.h"
#include "artus/detail/core/units.h"
#include "artus/detail/exchange/tracker_table.h"
#include "artus/detail/training/assessment.h"
#include "artus/detail/training/patient_plans.h"
#include "artus/detail/training/player.h"
#include "artus/detail/training/tracked_list.h"

namespace artus {
namespace {

struct AssessOptions {
  std::filesystem::path recording;
  std::filesystem::path poses;
  TrackerFileOptions tracker;
  JointOptions joint;
  std::filesystem::path tissue;
  std::string scenario;
  std::string tissue_unit = "mm";
  std::string target;
  std::vector<std::string> avoid;
  std::filesystem::path out;
  int gauge = 22;
  double depth_mm = 40;
  bool sort = false;
  bool no_pictures = false;
  bool draw = false;
  bool json = false;
};

Result<std::shared_ptr<const Scene>> load_tissue(const AssessOptions& options) {
  const double unit = options.tissue_unit == "m" ? 1 : kMillimetre;
  const auto mesh = read_surface(options.tissue, unit);
  ARTUS_TRY(mesh);
  auto sound = repair_surface(*mesh);
  ARTUS_TRY(sound);
  return make_closed_body(sound->mesh.vertices, sound->mesh.triangles,
                          options.tissue.stem().string());
}

Result<std::shared_ptr<const Scene>> load_body(const AssessOptions& options) {
  if (!options.tissue.empty()) return load_tissue(options);
  const auto joint = load(options.joint, make_progress_printer(options.json));
  ARTUS_TRY(joint);
  return std::make_shared<const Scene>(*joint);
}

/// A target by name or place, and NAME or NAME:MARGIN in mm.
Result<Goals> goals_of(const AssessOptions& options, const CompiledJoint& joint) {
  GoalNames names;
  if (options.target.find(',') != std::string::npos) {
    const auto point = parse_point_mm(options.target, "--target");
    ARTUS_TRY(point);
    names.point = *point;
    names.point_name = "the point " + options.target;
  } else {
    names.structure = options.target;
  }
  for (const std::string& text : options.avoid) {
    const std::size_t colon = text.find(':');
    double margin = 0;
    if (colon != std::string::npos) {
      const std::string number = text.substr(colon + 1);
      if (!number_in(0, 50).problem(number).empty())
        return fail(ErrorCode::malformed, "'" + number + "' is not a margin of 0 to 50 mm",
                    "--avoid");
      margin = std::stod(number) * kMillimetre;
    }
    names.avoid.emplace_back(text.substr(0, colon), margin);
  }
  return make_goals(joint, names);
}

/// Timed poses of a list, which may be sorted, or of what a tracker wrote.
Result<TrackedList> read_list(const AssessOptions& options) {
  if (options.tracker.calibration.empty()) {
    const std::string extension = options.poses.extension().string();
    const bool text = extension == ".csv" || extension == ".jsonl";
    const auto bytes = text ? read_bytes(options.poses) : Result<std::string>();
    ARTUS_TRY(bytes);
    if (text && (is_pose_list(options.poses, *bytes) || !is_tracker_table(*bytes)))
      return parse_tracked_list(*bytes, options.poses.string(), {options.sort});
  }
  auto file = read_pose_file_of(options.poses, options.tracker, PoseHand::either);
  ARTUS_TRY(file);
  TrackedList list;
  list.notices = std::move(file->notices);
  for (const ListedPose& pose : file->poses) {
    if (!pose.time)
      return fail(ErrorCode::invalid, "every pose needs its time_s", options.poses.string());
    list.poses.push_back({*pose.time, pose.X_JN,
                          pose.has_probe ? std::optional(pose.X_JP) : std::nullopt,
                          pose.needle_given, pose.probe_given});
  }
  return list;
}

Result<Assessment> assess_poses(const AssessOptions& options) {
  const auto list = read_list(options);
  ARTUS_TRY(list);
  const auto scene = load_body(options);
  ARTUS_TRY(scene);
  MeterOptions meter;
  meter.image_depth = options.depth_mm * kMillimetre;
  const auto shape = needle_of_flag(options.gauge);
  ARTUS_TRY(shape);
  meter.needle = *shape;
  auto goals = goals_of(options, (*scene)->joint());
  ARTUS_TRY(goals);
  meter.goals = std::move(*goals);
  return assess_list(*list, *scene, std::move(meter));
}

/// Sights as the session measured them, or of pictures that are drawn now.
SightSource sights_of(const AssessOptions& options) {
  if (options.no_pictures) return SightSource::none;
  return options.draw ? SightSource::drawn : SightSource::recorded;
}

/// Says that pictures will be drawn, which is what takes long.
void tell_pictures(const AssessOptions& options, const Recording& recording) {
  constexpr std::size_t kMany = 400;  // some seconds
  const bool never_drawn = std::none_of(recording.frames.begin(), recording.frames.end(),
                                        [](const FrameRecord& frame) { return frame.digest != 0; });
  if (options.json || options.no_pictures || recording.frames.size() < kMany) return;
  if (!options.draw && !never_drawn) return;
  std::fprintf(stderr,
               "drawing %zu pictures for tip_visible; --no-pictures measures all else at once\n",
               recording.frames.size());
}

/// A recording of a scenario's attempt, against its goals.
Result<Assessment> assess_attempt(const AssessOptions& options) {
  auto scenario = find_scenario(options.scenario);
  ARTUS_TRY(scenario);
  const auto scene =
      load_scene(*scenario, options.joint.joint, make_progress_printer(options.json));
  ARTUS_TRY(scene);
  follow_patient(*scenario, **scene);
  const auto recording = read_any_recording(options.recording, *scene, options.tracker);
  ARTUS_TRY(recording);
  tell_pictures(options, *recording);
  auto meter = make_meter_options(*scenario, (*scene)->joint(), recording->head.params);
  ARTUS_TRY(meter);
  return assess_recording(*recording, *scene, std::move(meter->goals), sights_of(options));
}

Result<Assessment> assess_file(const AssessOptions& options) {
  if (!options.scenario.empty()) return assess_attempt(options);
  const auto scene = load_body(options);
  ARTUS_TRY(scene);
  const auto recording =
      read_any_recording(options.recording, *scene, options.tracker,
                         options.no_pictures ? RecordedPictures::none : RecordedPictures::listed);
  ARTUS_TRY(recording);
  tell_pictures(options, *recording);
  auto goals = goals_of(options, (*scene)->joint());
  ARTUS_TRY(goals);
  return assess_recording(*recording, *scene, std::move(*goals), sights_of(options));
}

void print(const Assessment& a) {
  for (const auto* rows : {&a.metrics, &a.table}) {
    for (const Metric& m : *rows)
      if (m.value)
        std::printf("%-7s %-32s %14.6f %s\n", m.role.c_str(), m.name.c_str(), *m.value,
                    m.unit.c_str());
    if (!rows->empty())
      std::printf("  (%s: %s)\n", rows == &a.metrics ? "motion" : "table",
                  rows->front().rule.filter.c_str());
  }
  for (const AttemptEvent& e : a.events)
    std::printf("%9.2f s  %-12s %s\n", e.time, e.kind.c_str(), e.text.c_str());
  for (const std::string& notice : a.notices) std::printf("note: %s\n", notice.c_str());
}

Result<void> write(const Assessment& a, const std::filesystem::path& folder) {
  ARTUS_TRY(write_text(folder / "metrics.json", to_json(a).dump(2) + "\n"));
  ARTUS_TRY(write_text(folder / "metrics.tsv", to_tsv(a.table)));
  return write_text(folder / "metrics.csv", to_csv(a.metrics));
}

ExitCode run_assess(const AssessOptions& options) {
  const auto refuse = [&](const char* why, const char* flag) {
    return report_error({ErrorCode::malformed, why, flag}, options.json);
  };
  if (options.recording.empty() == options.poses.empty())
    return refuse("give a recording or a list of poses", "--poses");
  if (!options.scenario.empty() && options.recording.empty())
    return refuse("a scenario goes with a recording of one of its attempts", "--scenario");
  const bool has_body = !options.scenario.empty() || !options.joint.joint.empty();
  if (options.tissue.empty() != has_body)
    return refuse("give a joint or a closed surface (--tissue)", "--joint");
  if (!options.recording.empty() && !has_body)
    return refuse("a recording needs the joint that it was made with", "--joint");
  const auto assessment = options.poses.empty() ? assess_file(options) : assess_poses(options);
  if (!assessment) return report_error(assessment.error(), options.json);
  if (!options.out.empty())
    if (const auto written = write(*assessment, options.out); !written)
      return report_error(written.error(), options.json);
  if (options.json)
    std::cout << to_json(*assessment).dump(2) << '\n';
  else
    print(*assessment);
  return ExitCode::ok;
}

}  // namespace

void add_assess_command(Command& app, ExitCode& code) {
  auto options = std::make_shared<AssessOptions>();
  Command* command = add_command(
      app, "assess", "Measure a recorded puncture: metrics with their definitions",
      "From a recording of --record, or from timed poses of any tracker (.csv, .jsonl; the format\n"
      "of sweep, also with _m for _mm and quaternion_wxyz; .igs.mha of 3D Slicer and PLUS). A "
      "list\n"
      "in place of a recording leads a session, so that forces and pictures are measured, too.\n"
      "--out writes metrics.json, metrics.csv and metrics.tsv, a table in the four columns of\n"
      "PerkTutor.\n"
      "Examples:\n"
      "  artus assess session.rec -j meshes/simple-shoulder --target bursa --out out\n"
      "  artus assess --poses tracked.csv --tissue phantom.stl --out out\n"
      "  artus assess attempts/ID/session.rec --scenario gel-find\n"
      "  artus assess tracked.igs.mha -j meshes/simple-shoulder --target bursa\n"
      "  artus assess --poses tracked.jsonl -j shoulder.artus --target=-18.7,-6.3,25 \\\n"
      "    --avoid axillary_nerve:3 --json");
  command->add_option("recording", options->recording,
                      "file of --record, or a list of poses that leads a session");
  command->add_option("--poses", options->poses,
                      "timed poses of needle and probe: a list, or a tracker's file");
  add_tracker_file_options(command, options->tracker);
  add_joint_options(command, options->joint);
  command->get_option("--joint")->required(false);
  command->add_option("--tissue", options->tissue, "closed surface in place of a joint");
  command->add_option("--tissue-unit", options->tissue_unit, "of the surface's file")
      ->one_of({"mm", "m"})
      ->capture_default_str();
  command->add_option("--scenario", options->scenario,
                      "of which the recording is an attempt: body, target, zones and entry");
  command->add_option("--target", options->target, "a structure's name, or x,y,z in mm");
  command->add_option("--avoid", options->avoid, "NAME or NAME:MARGIN in mm; several times");
  command->add_option("--gauge", options->gauge, "of the needle, with --poses")
      ->capture_default_str();
  command->add_option("--depth", options->depth_mm, "of the picture in mm, with --poses")
      ->check(number_in(10, 300))
      ->capture_default_str();
  command->add_option("--out,-o", options->out, "folder for the files");
  command->add_flag("--sort", options->sort, "sort poses by their times first");
  command->add_flag("--no-pictures", options->no_pictures,
                    "leave pictures out (tip_visible has no value)");
  command->add_flag("--draw", options->draw,
                    "draw a recording's pictures again in place of what was measured then");
  command->add_flag("--json", options->json, "print all as JSON");
  on_run(command, code, [options] { return run_assess(*options); });
}

}  // namespace artus
