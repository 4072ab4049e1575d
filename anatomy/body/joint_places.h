// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <string>

#include "artus/core/geometry.h"

namespace artus {

/// A named point of the joint, in frame J.
struct Landmark {
  std::string name;
  Vec3 position = Vec3::Zero();  ///< m
};

/// One of the planned needle passes of a scenario: skin entry and target, in frame J.
struct PlannedInjection {
  std::string name;
  Vec3 entry = Vec3::Zero();   ///< m
  Vec3 target = Vec3::Zero();  ///< m
  int line = 0;                ///< of joint.toml; 0: of no file
};

}  // namespace artus
