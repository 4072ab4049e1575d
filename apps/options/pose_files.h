// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <filesystem>
#include <memory>
#include <vector>

#include "artus/core/result.h"
#include "artus/dataset/pose_list.h"
#include "artus/detail/apps/options/view_options.h"
#include "artus/detail/exchange/led_session.h"
#include "artus/session/recording.h"

namespace artus {

/// The flags of every command that draws a list of poses.
struct PoseListOptions {
  JointOptions joint;
  ViewOptions view;
  std::filesystem::path poses;
  bool json = false;
};
void add_pose_list_options(Command* command, PoseListOptions& options);

/// Poses from any file that holds some: a list (.jsonl, .csv), or a sequence of 3D Slicer or PLUS
/// (.mha). Errors: those of read_poses, read_mha and poses_of.
[[nodiscard]] Result<std::vector<ListedPose>> read_any_poses(const std::filesystem::path& file,
                                                             PoseHand needed = PoseHand::probe);

/// A recording, or what a session records in which such poses lead probe and needle (with serve's
/// settings; `pictures`: of a led one). Errors: those of read_recording, read_any_poses and
/// record_led_session.
[[nodiscard]] Result<Recording> read_any_recording(
    const std::filesystem::path& file, const std::shared_ptr<const Scene>& scene,
    RecordedPictures pictures = RecordedPictures::drawn);

}  // namespace artus
