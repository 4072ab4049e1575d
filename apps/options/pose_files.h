// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "artus/core/result.h"
#include "artus/dataset/pose_list.h"
#include "artus/detail/apps/options/view_options.h"
#include "artus/detail/exchange/led_session.h"
#include "artus/detail/exchange/tracker_file.h"
#include "artus/session/recording.h"

namespace artus {

/// What a tracker's file needs besides its name.
struct TrackerFileOptions {
  std::filesystem::path calibration;  ///< empty: poses are those of probe and needle themselves
  std::string probe = "ProbeToReference";
  std::string needle = "NeedleToReference";
};
void add_tracker_file_options(Command* command, TrackerFileOptions& options);

/// The flags of every command that draws a list of poses.
struct PoseListOptions {
  TrackerFileOptions tracker;
  JointOptions joint;
  ViewOptions view;
  std::filesystem::path poses;
  bool json = false;
};
void add_pose_list_options(Command* command, PoseListOptions& options);

/// Poses from any file that holds some (read_pose_file), with what was left out or assumed. Errors:
/// those of read_pose_file and read_tracker_calibration.
[[nodiscard]] Result<PoseFile> read_pose_file_of(const std::filesystem::path& file,
                                                 const TrackerFileOptions& tracker,
                                                 PoseHand needed = PoseHand::probe);

/// The poses alone; what is to be told goes to stderr. Errors: the same.
[[nodiscard]] Result<std::vector<ListedPose>> read_any_poses(const std::filesystem::path& file,
                                                             const TrackerFileOptions& tracker,
                                                             PoseHand needed = PoseHand::probe);

/// A recording, or what a session records in which such poses lead probe and needle (with serve's
/// settings; `pictures`: of a led one). Errors: those of read_recording, read_any_poses and
/// record_led_session.
[[nodiscard]] Result<Recording> read_any_recording(
    const std::filesystem::path& file, const std::shared_ptr<const Scene>& scene,
    const TrackerFileOptions& tracker, RecordedPictures pictures = RecordedPictures::drawn);

}  // namespace artus
