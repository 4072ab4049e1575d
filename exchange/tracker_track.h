// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "artus/core/geometry.h"

namespace artus {

/// Where a tracker saw its sensors at one instant.
struct TrackFrame {
  double time = 0;             ///< s
  std::optional<Pose> probe;   ///< m, in the file's reference; empty: not seen
  std::optional<Pose> needle;  ///< the same
  /// Their orientations as matrices of the file have them, a little off a rotation.
  std::optional<Eigen::Matrix3d> probe_given{};
  std::optional<Eigen::Matrix3d> needle_given{};
};

/// The motion of probe and needle as a file of a tracker has it.
struct TrackerTrack {
  std::vector<TrackFrame> frames;  ///< by rising time; each has a hand at least
  /// Reference of a file of 3D Slicer and PLUS is RAS; that of a table is the joint's frame.
  bool reference_is_ras = false;
  std::vector<std::string> notices;  ///< what was left out or assumed, for people
};

/// How transforms are called in the file: "NeedleToReference". A frame after "To" that the file
/// does not name is looked for through others.
struct TrackNames {
  std::string probe = "ProbeToReference";
  std::string needle = "NeedleToReference";
};

}  // namespace artus
