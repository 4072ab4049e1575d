// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include "artus/anatomy/joint_file.h"
#include "artus/detail/core/toml_table.h"

namespace artus {

/// The [view.NAME] tables of a joint file, in the order of their names. What is wrong goes to the
/// problems of `toml`: a probe without direction, a pose or structure that is not there, a range of
/// depth that is none. Requires: `joint` has its structures and poses.
[[nodiscard]] std::vector<StandardView> read_views(TomlTable& toml, double unit,
                                                   const JointFile& joint);

}  // namespace artus
