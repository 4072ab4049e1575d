// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstdint>
#include <string>

#include "artus/core/geometry.h"

namespace artus {

using TissueId = std::uint16_t;

/// How fibres run where the structure is bent: from the end that lies farthest against the fibre
/// axis to the one that lies farthest along it, or everywhere along the axis, turned only as much
/// as it takes to run beside the skin (a layer that is wound around a bone has no two ends).
enum class FibreCourse : std::uint8_t { ends, layer };

/// One structure's share of the body after overlaps are resolved.
struct Region {
  std::string name;     ///< the structure's name; "outside", "beyond", or the filler's name
  TissueId tissue = 0;  ///< index into CompiledJoint::tissues (for outside: air's place holder gel)
  Vec3 fibre_axis = Vec3::Zero();  ///< unit, or zero when unknown
  FibreCourse fibre_course = FibreCourse::ends;
};

}  // namespace artus
