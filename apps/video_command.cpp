// SPDX-License-Identifier: AGPL-3.0-or-later
#include <cstdio>
#include <iostream>
#include <memory>

#include "artus/detail/apps/options/pose_files.h"
#include "artus/detail/dataset/sweep_video.h"

namespace artus {
namespace {

struct VideoOptions {
  JointOptions joint;
  ViewOptions view;
  std::filesystem::path path;
  TrackerFileOptions tracker;
  std::filesystem::path out;
  double frames_per_second = 25;
  bool labels = false;
  bool json = false;
};

ExitCode run_video(const VideoOptions& options) {
  const auto poses = read_any_poses(options.path, options.tracker);
  if (!poses) return report_error(poses.error(), options.json);
  const auto loaded = load_view(options.joint, options.view, options.json);
  if (!loaded) return report_error(loaded.error(), options.json);
  const auto video =
      write_sweep_video(loaded->scene, *poses, options.out,
                        {loaded->view.transducer, loaded->view.settings, loaded->view.needle_shape,
                         options.frames_per_second, options.labels},
                        make_progress_printer(options.json));
  if (!video) {
    Error error = video.error();
    if (error.where.empty()) error.where = options.path.string();
    return report_error(error, options.json);
  }
  if (options.json) {
    std::cout << nlohmann::json{{"joint", loaded->joint().name},
                                {"video", video->file.string()},
                                {"frames", video->frames},
                                {"frames_per_second", options.frames_per_second}}
                     .dump(2)
              << '\n';
  } else {
    std::printf("%s: %zu frames at %.4g a second\n", video->file.c_str(), video->frames,
                options.frames_per_second);
  }
  return ExitCode::ok;
}

}  // namespace

void add_video_command(Command& image, ExitCode& code) {
  auto options = std::make_shared<VideoOptions>();
  Command* command = add_command(
      image, "video", "A path of probe (and needle) as MP4 or AVI",
      "The path is a list of poses as for `artus sweep`. With \"time_s\" in every pose, probe and\n"
      "needle move from pose to pose in that time; without, each pose is one frame.\n"
      "Examples:\n"
      "  artus image video -j shoulder.artus --path path.jsonl -o out/path.mp4\n"
      "  artus image video -j shoulder.artus --path path.csv --labels --fps 15 -o out/path.avi");
  add_joint_options(command, options->joint);
  add_patient_option(command, options->joint.patient);
  command->add_option("--path", options->path, "list of poses, or a tracker's file")->required();
  add_tracker_file_options(command, options->tracker);
  add_imaging_options(command, options->view);
  command->add_option("-o,--out", options->out, "video file (.mp4, .avi)")->required();
  command->add_option("--fps", options->frames_per_second, "frames a second")
      ->check(number_in(1, 240))
      ->capture_default_str();
  command->add_flag("--labels", options->labels, "the true labels beside each image");
  command->add_flag("--json", options->json, "machine-readable output");
  on_run(command, code, [options] { return run_video(*options); });
}

}  // namespace artus
