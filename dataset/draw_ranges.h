// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "artus/core/result.h"
#include "artus/detail/core/units.h"

namespace artus {

/// From lowest to highest; equal: always that.
struct DrawRange {
  double low = 0;
  double high = 0;
};

/// Where a drawn needle's tip must be.
enum class TipPlace : std::uint8_t {
  anywhere,
  in_picture,  ///< between the outermost lines and in the slice
  visible      ///< and neither bone nor gas nor a gap lies between the face and the tip
};
inline constexpr std::array<std::string_view, 3> kTipPlaceNames{"anywhere", "in_picture",
                                                                "visible"};

/// How far drawn frames spread. Probe: about the joint's default pose, in its own axes, then set
/// down on the skin. Needle: about a planned injection (all are as likely; the default needle where
/// none is planned), for a share of the frames turned into the picture's plane. What is empty is
/// not drawn: the sweep's own needle, transducer and joint. SI.
struct DrawRanges {
  DrawRange lateral{-10e-3, 10e-3};             ///< m, along the probe's x
  DrawRange elevation{-10e-3, 10e-3};           ///< m, along its y
  DrawRange turn{-20 * kDegree, 20 * kDegree};  ///< rad, about z
  DrawRange tilt{-10 * kDegree, 10 * kDegree};  ///< rad, about x
  DrawRange rock{-10 * kDegree, 10 * kDegree};  ///< rad, about y
  double needle_share = 0.7;                    ///< of the frames with a needle
  double in_plane_share = 0.7;                  ///< of the needles that lie in the picture's plane
  DrawRange along{-20e-3, 5e-3};  ///< m, of the tip from the target, deeper is positive
  DrawRange aside{-3e-3, 3e-3};   ///< m, of the tip off the planned line, both ways
  DrawRange slant{-10 * kDegree,
                  10 * kDegree};  ///< rad, of the needle off the planned line, both ways
  TipPlace tip = TipPlace::in_picture;
  double tip_share = 1;  ///< of the needles for which `tip` holds
  /// Tissues or structures that neither tip nor shaft may be in.
  std::vector<std::string> not_in{"bone", "cartilage"};
  double not_in_share = 1;                    ///< of the needles for which `not_in` holds
  std::vector<int> gauges;                    ///< as likely as often they are named
  std::optional<DrawRange> length;            ///< m, hub to tip
  std::optional<double> echogenic_share;      ///< of the needles that are dimpled
  std::vector<std::string> transducers;       ///< names or .toml files
  std::vector<std::filesystem::path> joints;  ///< further patients beside the sweep's joint
  std::size_t drawn_patients = 0;             ///< so many of the sweep's joint, drawn by its seed
  double press_share = 0;                     ///< of the frames in which the probe presses
  DrawRange press_depth{0, 4e-3};             ///< m, along the beam
};

/// Reads ranges as TOML (docs/datasets.md); a range is [low, high]. What is missing stays as above;
/// files are found beside `name`. Errors: malformed, invalid (unknown key, low above high, a gauge
/// that there is not), all in one message.
[[nodiscard]] Result<DrawRanges> parse_draw_ranges(std::string_view text, const std::string& name);
[[nodiscard]] Result<DrawRanges> read_draw_ranges(const std::filesystem::path& file);

/// A number that two ranges share only when they draw the same.
[[nodiscard]] std::uint64_t hash_of(const DrawRanges& ranges);

}  // namespace artus
