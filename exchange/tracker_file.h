// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "artus/core/result.h"
#include "artus/dataset/pose_list.h"
#include "artus/detail/exchange/tracker_calibration.h"
#include "artus/detail/exchange/tracker_track.h"

namespace artus {

/// Poses in the joint, and what was left out or assumed on the way to them.
struct PoseFile {
  std::vector<ListedPose> poses;
  std::vector<std::string> notices;  ///< for people
};

/// How a file of poses is read.
struct PoseFileOptions {
  PoseHand needed = PoseHand::probe;  ///< frames without it are left out, and told
  TrackNames names;                   ///< of transforms, in sequences and recordings of PerkTutor
  /// How the sensors sit; with it, poses of tables and lists are those of sensors in the tracker's
  /// Reference. Without: of a table or list in the joint's frame, else in RAS.
  std::optional<TrackerCalibration> calibration;
};

/// Whether a file is one of artus' own lists (.jsonl, .csv with its columns).
[[nodiscard]] bool is_pose_list(const std::filesystem::path& file, std::string_view text);

/// Whatever holds poses: lists of artus, sequences of PLUS and 3D Slicer (.mha, .mhd, .nrrd),
/// recordings of PerkTutor (.xml), logs of NDI, tables with quaternions, SOFA's. What it is shows
/// in its text, not in its name. Errors: those of read_poses, track_of, parse_perk_recording and
/// parse_tracker_table; invalid, when no frame has the hand that is needed.
[[nodiscard]] Result<PoseFile> read_pose_file(const std::filesystem::path& file,
                                              const PoseFileOptions& options = {});

}  // namespace artus
