// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "artus/core/geometry.h"
#include "artus/core/result.h"

namespace artus {

/// Both hands at one instant, as any tracker gives them.
struct TrackedPose {
  double time = 0;  ///< s
  std::optional<Pose> X_JN;
  std::optional<Pose> X_JP;
  /// Orientations as the tracker's matrices have them, a little off a rotation; empty: those above.
  std::optional<Eigen::Matrix3d> needle_given{};
  std::optional<Eigen::Matrix3d> probe_given{};
};

/// A list of them, and what was peculiar about it.
struct TrackedList {
  std::vector<TrackedPose> poses;    ///< by time
  std::vector<std::string> notices;  ///< gaps, poses of one time, what was sorted; for people
};

struct TrackedListOptions {
  bool sort = false;       ///< put by time what is not
  double gap = 0.5;        ///< s without a pose that are told
  double longest = 10800;  ///< s; a longer list is refused
};

/// Reads timed poses of needle and probe from JSON lines (.jsonl) or CSV (.csv): the format of a
/// sweep (docs/echography.md), where either hand may be missing, lengths may be in _m instead of
/// _mm, and a hand may be given by position (of the tip, of the face's centre) and quaternion_wxyz
/// (normalised; its norm must be 0.9 to 1.1) instead of directions. A needle of entry and tip is
/// taken not to spin about itself. Errors: not_found, unreadable, unsupported (extension),
/// malformed or invalid with file:line (unknown key, number that is none, no time, time that falls
/// and was not to be sorted, neither hand, one companion without the others).
[[nodiscard]] Result<TrackedList> read_tracked_list(const std::filesystem::path& file,
                                                    const TrackedListOptions& options = {});

/// The same from memory; `name` stands in messages and lends its extension.
[[nodiscard]] Result<TrackedList> parse_tracked_list(std::string_view text, const std::string& name,
                                                     const TrackedListOptions& options = {});

}  // namespace artus
