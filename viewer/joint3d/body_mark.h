// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstdint>
#include <vector>

#include "artus/anatomy/compiled_joint.h"

namespace artus {

/// A small map of the joint, skin dark and bones lighter, on which a scanner marks where its probe
/// is. It is seen along the beam of the joint's usual probe: x to its right, y down.
struct BodyMark {
  int size = 0;                    ///< pixels, both ways
  std::vector<std::uint8_t> grey;  ///< (size, size), x fastest; 0 beside the body
  Pose X_JM = Pose::Identity();    ///< middle of the map, as the usual probe is turned
  double pixel = 0;                ///< m
};

/// Requires: size > 8. Cost: linear in the interfaces.
[[nodiscard]] BodyMark make_body_mark(const CompiledJoint& joint, int size = 72);

/// The probe's face on the map, pixels; the first end is its marked side. It stays on the map.
struct MarkLine {
  float x0 = 0;
  float y0 = 0;
  float x1 = 0;
  float y1 = 0;
};
[[nodiscard]] MarkLine probe_on_mark(const BodyMark& mark, const Pose& X_JP, double probe_width);

}  // namespace artus
