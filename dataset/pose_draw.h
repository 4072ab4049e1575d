// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "artus/core/result.h"
#include "artus/core/units.h"
#include "artus/dataset/pose_list.h"
#include "artus/dataset/shards.h"
#include "artus/raycast/scene.h"

namespace artus {

/// From lowest to highest; equal: always that.
struct DrawRange {
  double low = 0;
  double high = 0;
};

/// How far drawn poses spread. Probe: about the joint's default pose, in its own axes, then set
/// down on the skin. Needle: about a planned injection (all are as likely; the default needle where
/// none is planned), for a share of the frames turned into the picture's plane. SI.
struct DrawRanges {
  DrawRange lateral{-10e-3, 10e-3};             ///< m, along the probe's x
  DrawRange elevation{-10e-3, 10e-3};           ///< m, along its y
  DrawRange turn{-20 * kDegree, 20 * kDegree};  ///< rad, about z
  DrawRange tilt{-10 * kDegree, 10 * kDegree};  ///< rad, about x
  DrawRange rock{-10 * kDegree, 10 * kDegree};  ///< rad, about y
  double needle_share = 0.7;                    ///< of the frames with a needle
  double in_plane_share = 0.5;                  ///< of the needles that lie in the picture's plane
  DrawRange along{-20e-3, 5e-3};  ///< m, of the tip from the target, deeper is positive
  DrawRange aside{-3e-3, 3e-3};   ///< m, of the tip off the planned line, both ways
  DrawRange slant{-10 * kDegree,
                  10 * kDegree};  ///< rad, of the needle off the planned line, both ways
};

/// Reads ranges as TOML, tables probe (lateral_mm, elevation_mm, turn_deg, tilt_deg, rock_deg) and
/// needle (share, in_plane, along_mm, aside_mm, slant_deg); a range is [low, high]. What is missing
/// stays as above. Errors: malformed, invalid (unknown key, low above high), all in one message.
[[nodiscard]] Result<DrawRanges> parse_draw_ranges(std::string_view text, const std::string& name);
[[nodiscard]] Result<DrawRanges> read_draw_ranges(const std::filesystem::path& file);

/// Poses drawn at random: number i depends on joint, ranges, seed and i alone, not on how many
/// there are or who asks. Cost: some us a pose.
[[nodiscard]] PoseSource drawn_poses(std::shared_ptr<const Scene> scene, const DrawRanges& ranges,
                                     std::uint64_t seed, std::size_t count);

}  // namespace artus
