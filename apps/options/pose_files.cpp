// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/apps/options/pose_files.h"

#include <cstdio>
#include <string>
#include <utility>

#include "artus/detail/apps/options/session_options.h"

namespace artus {
namespace {

constexpr const char* kPoseFiles =
    "poses: a list (.jsonl, .csv), or what a tracker wrote (.igs.mha, .nrrd, .xml, .csv, .txt)";

/// Whether a file's name says that poses are in it; recordings of artus have any other.
bool is_named_for_poses(const std::filesystem::path& file) {
  const std::string extension = file.extension().string();
  for (const char* known :
       {".jsonl", ".csv", ".mha", ".mhd", ".nrrd", ".xml", ".txt", ".tsv", ".log", ".tum"})
    if (extension == known) return true;
  return false;
}

}  // namespace

void add_tracker_file_options(Command* command, TrackerFileOptions& options) {
  const char* group = "Files of trackers";
  command
      ->add_option("--calibration", options.calibration,
                   "how the tracker's sensors sit on probe, needle and joint (.toml); poses are "
                   "then those of sensors")
      ->group(group);
  command->add_option("--tracker-probe", options.probe, "name of the probe's transform")
      ->group(group)
      ->capture_default_str();
  command->add_option("--tracker-needle", options.needle, "name of the needle's transform")
      ->group(group)
      ->capture_default_str();
}

void add_pose_list_options(Command* command, PoseListOptions& options) {
  add_joint_options(command, options.joint);
  command->add_option("--poses", options.poses, kPoseFiles);
  add_tracker_file_options(command, options.tracker);
  add_imaging_options(command, options.view);
  command->add_flag("--json", options.json, "machine-readable output");
}

Result<PoseFile> read_pose_file_of(const std::filesystem::path& file,
                                   const TrackerFileOptions& tracker, PoseHand needed) {
  PoseFileOptions options;
  options.needed = needed;
  options.names = {tracker.probe, tracker.needle};
  if (!tracker.calibration.empty()) {
    auto calibration = read_tracker_calibration(tracker.calibration);
    ARTUS_TRY(calibration);
    options.calibration = *calibration;
  }
  return read_pose_file(file, options);
}

Result<std::vector<ListedPose>> read_any_poses(const std::filesystem::path& file,
                                               const TrackerFileOptions& tracker, PoseHand needed) {
  auto read = read_pose_file_of(file, tracker, needed);
  ARTUS_TRY(read);
  for (const std::string& notice : read->notices)
    std::fprintf(stderr, "note: %s: %s\n", file.c_str(), notice.c_str());
  return std::move(read->poses);
}

Result<Recording> read_any_recording(const std::filesystem::path& file,
                                     const std::shared_ptr<const Scene>& scene,
                                     const TrackerFileOptions& tracker, RecordedPictures pictures) {
  if (!is_named_for_poses(file)) return read_recording(file);
  const auto poses = read_any_poses(file, tracker, PoseHand::either);
  ARTUS_TRY(poses);
  const auto params = make_session_params(SessionOptions{}, scene->joint());
  ARTUS_TRY(params);
  return record_led_session(*poses, scene, *params, pictures);
}

}  // namespace artus
