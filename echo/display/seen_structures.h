// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "artus/anatomy/compiled_joint.h"
#include "artus/echo/labels.h"

namespace artus {

/// What is not so of a structure that a standard view asks for.
enum class SightFault { none, not_seen, depth, order, side };

/// A structure of a standard view as the truth of its picture has it.
struct SeenStructure {
  std::string structure;
  double share = 0;  ///< of the picture's columns that hold it, 0 to 1
  double depth = 0;  ///< m below the skin, of its upper border: the median of those columns
  double side = 0;   ///< where most of it lies, -1 at the left edge to 1 at the right
  SightFault fault = SightFault::none;
};

/// Of the picture's columns a structure that is seen holds at least so many.
inline constexpr double kSeenShare = 0.05;

/// The view's structures, in its order. One without a side must not lie before the one before it
/// without a side, in the columns that hold both. Requires: `labels` are of the joint, at the view.
[[nodiscard]] std::vector<SeenStructure> find_seen(const LabelImage& labels,
                                                   const CompiledJoint& joint,
                                                   const StandardView& view);

}  // namespace artus
