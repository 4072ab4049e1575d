// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "artus/core/geometry.h"
#include "artus/core/result.h"
#include "artus/detail/simulation/two_phase_gesture.h"

namespace artus {

/// How a tracker's sensors sit on the probe, the needle and the joint. As a file: TOML with the
/// tables transducer_to_probe, needle_tip_to_needle and reference_to_joint, each of which may be
/// missing and has `matrix`, four rows of four numbers in millimetres; `scale`, 0.5 to 2; and
/// insertion_point with
/// point_mm, axis and, optional, beside_probe_mm and steepness_deg (docs/openigtlink.md). Of all
/// hands: of trackers, of devices, of recorded files.
struct TrackerCalibration {
  /// The transducer's frame P (x lateral, z into the body) on the probe's sensor.
  Pose X_ProbeP = Pose::Identity();
  /// The needle's frame N (origin tip, z hub to tip) on the needle's sensor.
  Pose X_NeedleN = Pose::Identity();
  /// The tracker's reference in the joint.
  Pose X_JR;
  /// True lengths over those that the tracker says, where its scale is known to be off (a print
  /// that is too small, a field that was calibrated with a wrong ruler). Of its poses' places in
  /// Reference alone: sensors' matrices and devices in shared memory are 1:1, since any other scale
  /// would change every stiffness.
  double scale = 1;
  bool registered = false;  ///< reference_to_joint is known; else Reference is the joint in RAS
  /// Where the device's mechanics let a needle in, in W, and how it is laid beside the probe.
  std::optional<GestureParams> insertion;

  TrackerCalibration();
  /// A pose in Reference as the tracker says it, in true lengths.
  [[nodiscard]] Pose scaled(Pose X_RS) const {
    X_RS.translation() *= scale;
    return X_RS;
  }
};

/// Errors: malformed (with line), invalid (unknown key, not 16 numbers, a matrix that is not
/// rigid), all problems in one message.
[[nodiscard]] Result<TrackerCalibration> parse_tracker_calibration(std::string_view text,
                                                                   const std::string& name);
/// The same from a file. Errors: also not_found, unreadable.
[[nodiscard]] Result<TrackerCalibration> read_tracker_calibration(
    const std::filesystem::path& file);

/// The file's text; reading it gives the same calibration.
[[nodiscard]] std::string to_toml(const TrackerCalibration& calibration);

}  // namespace artus
