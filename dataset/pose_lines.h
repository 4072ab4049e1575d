// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "artus/core/geometry.h"
#include "artus/core/result.h"

namespace artus {

/// What a line of a list of poses says: probe and needle, each by position and directions or by
/// position and quaternion_wxyz; lengths in _mm or in _m (docs/echography.md).
struct PoseLine {
  std::string name;            ///< may be empty
  std::optional<double> time;  ///< s
  /// By their key in JSON without its unit, as "needle.tip"; SI.
  std::map<std::string, std::vector<double>> numbers;
  /// Hands that the line (or the header above it) names and that it has no numbers of: empty cells,
  /// seven zeros, null. A tracker did not see them.
  std::set<std::string> unseen;
};

enum class PoseFormat { json_lines, csv };
/// Of .jsonl and .csv. Errors: unsupported.
[[nodiscard]] Result<PoseFormat> pose_format_of(const std::filesystem::path& file);

/// Calls `each` for every line of a list of poses. Errors: of `each`; malformed or invalid with
/// name:line (unknown key or column, missing or not finite number, not one JSON object).
[[nodiscard]] Result<void> for_pose_lines(
    std::string_view text, const std::string& name, PoseFormat format,
    const std::function<Result<void>(const PoseLine& line, const std::string& where)>& each);

/// The probe's pose (origin at the face's centre, z along the beam); empty when the line has none.
/// Errors: invalid (half of what a pose needs, directions that are zero or parallel, a quaternion
/// whose norm is not 0.9 to 1.1).
[[nodiscard]] Result<std::optional<Pose>> probe_of(const PoseLine& line, const std::string& where);
/// The needle's (origin at the tip, z from hub to tip); of entry and tip its turn about itself is
/// free.
[[nodiscard]] Result<std::optional<Pose>> needle_of(const PoseLine& line, const std::string& where);

}  // namespace artus
