// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "artus/core/geometry.h"
#include "artus/core/result.h"

namespace artus {

/// One place of the probe, with or without a needle, of a list that a person or a program wrote.
struct ListedPose {
  std::string name;            ///< may be empty
  std::optional<double> time;  ///< s
  Pose X_JP = Pose::Identity();
  std::optional<Pose> X_JN;  ///< origin at the tip, z from hub to tip
  bool has_probe = true;     ///< false: X_JP is nowhere, in a list that is read for its needle
  /// Orientations as a tracker's matrices have them, a little off a rotation; empty: those above.
  std::optional<Eigen::Matrix3d> probe_given{};
  std::optional<Eigen::Matrix3d> needle_given{};
};

/// Which hand every pose of a list must have.
enum class PoseHand { probe, needle, either };

/// The most poses that sample_path makes: some 30 min at 1 kHz.
inline constexpr std::size_t kMaxSamples = 2'000'000;

/// Reads a list of poses, JSON lines (.jsonl) or CSV (.csv), as docs/echography.md describes them.
/// Errors: not_found, unreadable, unsupported (extension), malformed or invalid with file:line
/// (unknown key, missing or not finite number, zero or parallel directions, times that do not rise,
/// no pose at all, a place beyond 10 m from the origin, a pose without the hand that is needed).
/// Lines that name the needed hand and do not have it (a tracker did not see it) are left out;
/// `left_out` gets their number.
[[nodiscard]] Result<std::vector<ListedPose>> read_poses(const std::filesystem::path& file,
                                                         PoseHand needed = PoseHand::probe,
                                                         std::size_t* left_out = nullptr);

/// The same from memory; `name` stands in messages.
[[nodiscard]] Result<std::vector<ListedPose>> parse_poses_jsonl(std::string_view text,
                                                                const std::string& name,
                                                                PoseHand needed = PoseHand::probe,
                                                                std::size_t* left_out = nullptr);
[[nodiscard]] Result<std::vector<ListedPose>> parse_poses_csv(std::string_view text,
                                                              const std::string& name,
                                                              PoseHand needed = PoseHand::probe,
                                                              std::size_t* left_out = nullptr);

/// The poses at `rate` per second: between two listed ones the probe and the needle move straight
/// and turn evenly, and a needle is there when both have one. Without times each listed pose is
/// one. Errors: invalid (some poses have a time and others have none; the times make more than
/// `max_samples` poses at the rate).
[[nodiscard]] Result<std::vector<ListedPose>> sample_path(const std::vector<ListedPose>& poses,
                                                          double rate,
                                                          std::size_t max_samples = kMaxSamples);

/// The same as CSV, as read_poses takes it: each number with seventeen digits, the needle by its
/// tip and a point 100 mm before it. Requires: names without commas and line ends.
[[nodiscard]] std::string poses_csv(std::span<const ListedPose> poses);

}  // namespace artus
