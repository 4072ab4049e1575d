// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include "artus/anatomy/joint_file.h"
#include "artus/detail/core/toml_table.h"

namespace artus {

/// The [pose.NAME] tables of a joint file, in the order of their names. What is wrong goes to the
/// problems of `toml`: a structure that is not there, that is no bone or that moves twice, an axis
/// without direction, more than 120 degrees, a shift of more than 0.2 m. Requires: `joint` has its
/// structures, tissues and landmarks.
[[nodiscard]] std::vector<JointPose> read_poses(TomlTable& toml, double unit,
                                                const JointFile& joint);

/// m from the origin of frame J: no frame of a body lies farther.
inline constexpr double kFarthestPlace = 10;

/// A place in the joint's frame, in metres.
[[nodiscard]] Vec3 required_place(TomlTable& toml, std::string_view key, double unit);

/// Position, direction and lateral of a probe; nothing where they are no pose.
[[nodiscard]] std::optional<Pose> read_probe_pose(TomlTable& probe, double unit);

}  // namespace artus
