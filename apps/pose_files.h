// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <filesystem>
#include <vector>

#include "artus/core/result.h"
#include "artus/dataset/pose_list.h"

namespace artus {

/// Poses from any file that holds some: a list (.jsonl, .csv), or a sequence of 3D Slicer or PLUS
/// (.mha). Errors: those of read_poses, read_mha and poses_of.
[[nodiscard]] Result<std::vector<ListedPose>> read_any_poses(const std::filesystem::path& file);

}  // namespace artus
