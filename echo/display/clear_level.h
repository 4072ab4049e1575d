// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <vector>

#include "artus/anatomy/compiled_joint.h"

namespace artus {

/// How far the grains of an injected suspension have sunk.
struct Settling {
  Vec3 up_J = Vec3::UnitZ();  ///< unit, against gravity
  double fallen = 0;          ///< m, of a grain on its own
};

/// Up to where an injected suspension is cleared. Grains leave every roof behind at one speed, and
/// the clear liquid under it, being lighter, runs up: so it gathers above a level, and as much of
/// it as the roofs' area seen from above times the way that grains fell (Ponder, Nakamura and
/// Kuroda's law, [Acrivos1979]). Below it the liquid is as grey as it was.
class ClearLevels {
 public:
  ClearLevels() = default;
  /// Of the regions of `joint` that with_injected made of a liquid that scatters. Cost: some passes
  /// over the interfaces.
  ClearLevels(const CompiledJoint& joint, const Vec3& up_J);

  /// m along up_J of the level in a region; infinite: nothing there has cleared. Cost: a search
  /// among some dozen values.
  [[nodiscard]] double height(RegionId region, double fallen) const noexcept;

 private:
  struct Table {
    RegionId region = kOutside;
    double roof = 0;            // m^2, seen from above
    double top = 0;             // m
    double step = 0;            // m from one level to the next below
    std::vector<double> above;  // m^3 above each level
  };
  std::vector<Table> tables_;
};

}  // namespace artus
