// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "artus/detail/simulation/records.h"
#include "artus/detail/viewer/words/translation.h"

namespace artus {

/// What is to be told of the needle in one tick, from the truth.
struct NeedleReading {
  bool inside = false;
  std::string layer;  ///< under the tip, as a clinician says
  RegionId region = kOutside;
  double depth = 0;        ///< m, of the needle: no deeper than bone, which stops it
  double hand_excess = 0;  ///< m that the hand is further than the needle, on bone
  bool on_bone = false;
  bool hub_on_skin = false;
  double to_target = 0;     ///< m from the tip to the target
  bool in_plane = false;    ///< the tip and the shaft are in the picture
  double plane_offset = 0;  ///< m, of the tip from the image plane
  double plane_angle = 0;   ///< rad, between needle and image plane
};

/// In the body of `scene`, as it gives way there. `target_J`: where the tip shall be, in the body
/// at rest. Cost: one query along the shaft.
[[nodiscard]] NeedleReading read_needle(const Scene& scene, const HapticSnapshot& now,
                                        double needle_length, const std::optional<Vec3>& target_J,
                                        Language language);

/// The tip's pose in J as the needle is: held by bone where the hand goes on.
[[nodiscard]] Pose needle_pose(const HapticSnapshot& now, const NeedleReading& reading);

/// A structure's name where the picture shows it, in millimetres of the image.
struct PictureLabel {
  std::string name;
  RegionId region = kOutside;
  double x_mm = 0;
  double y_mm = 0;
};
/// The names of what truly lies in the image plane at X_JP, each once, where it is thickest; the
/// thinnest first, whose names have the least room to give way.
/// Cost: one query for each of some 30 columns.
[[nodiscard]] std::vector<PictureLabel> find_picture_labels(const Scene& scene, const Pose& X_JP,
                                                            double width, double depth,
                                                            Language language);

}  // namespace artus
