// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "artus/core/geometry.h"

namespace artus {

/// A bone that moved as a rigid body: its point p of the rest is at X_J * p.
struct BoneMotion {
  std::string structure;        ///< region name of a hard tissue
  Pose X_J = Pose::Identity();  ///< frame J; turns by less than half a turn
};

/// A way the joint can be held: bones that are named have moved, the others are as compiled.
struct JointPose {
  std::string name;                 ///< [a-z0-9_]+, unique
  std::string title;                ///< one line for people
  std::vector<BoneMotion> motions;  ///< none: the joint as it was compiled
  /// Where the probe is put in this pose; not given: it goes with the skin below it.
  std::optional<Pose> X_JP;
};

}  // namespace artus
