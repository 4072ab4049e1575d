// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/apps/options/pose_files.h"

#include "artus/detail/apps/options/session_options.h"
#include "artus/detail/exchange/sequence_file.h"

namespace artus {

void add_pose_list_options(Command* command, PoseListOptions& options) {
  add_joint_options(command, options.joint);
  command->add_option("--poses", options.poses, "list of poses (.jsonl, .csv, .mha)");
  add_imaging_options(command, options.view);
  command->add_flag("--json", options.json, "machine-readable output");
}

Result<std::vector<ListedPose>> read_any_poses(const std::filesystem::path& file, PoseHand needed) {
  if (file.extension() != ".mha") return read_poses(file, needed);
  const auto sequence = read_mha(file);
  ARTUS_TRY(sequence);
  auto poses = poses_of(*sequence);
  if (!poses) return fail(poses.error().code, poses.error().message, file.string());
  return poses;
}

Result<Recording> read_any_recording(const std::filesystem::path& file,
                                     const std::shared_ptr<const Scene>& scene,
                                     RecordedPictures pictures) {
  const auto extension = file.extension();
  if (extension != ".mha" && extension != ".jsonl" && extension != ".csv")
    return read_recording(file);
  const auto poses = read_any_poses(file);
  ARTUS_TRY(poses);
  const auto params = make_session_params(SessionOptions{}, scene->joint());
  ARTUS_TRY(params);
  return record_led_session(*poses, scene, *params, pictures);
}

}  // namespace artus
