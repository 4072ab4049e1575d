// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/apps/pose_files.h"

#include "artus/exchange/sequence_file.h"

namespace artus {

Result<std::vector<ListedPose>> read_any_poses(const std::filesystem::path& file) {
  if (file.extension() != ".mha") return read_poses(file);
  const auto sequence = read_mha(file);
  ARTUS_TRY(sequence);
  auto poses = poses_of(*sequence);
  if (!poses) return fail(poses.error().code, poses.error().message, file.string());
  return poses;
}

}  // namespace artus
