// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <vector>

#include "artus/detail/anatomy/body/joint_pose.h"
#include "artus/detail/anatomy/body/standard_view.h"
#include "artus/detail/core/byte_stream.h"

namespace artus {

/// Poses and views in a compiled file. A reader that meets bad values refuses (ByteReader::ok).
void put_pose(ByteWriter& out, const Pose& pose);
[[nodiscard]] Pose get_pose(ByteReader& in);
void put_poses(ByteWriter& out, const std::vector<JointPose>& poses);
[[nodiscard]] std::vector<JointPose> get_poses(ByteReader& in);
void put_views(ByteWriter& out, const std::vector<StandardView>& views);
[[nodiscard]] std::vector<StandardView> get_views(ByteReader& in);

}  // namespace artus
