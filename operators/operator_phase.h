// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <string>

#include "artus/core/geometry.h"
#include "artus/detail/anatomy/body/tet_mesh.h"

namespace artus {

/// One thing the simulated operator does with the needle.
struct OperatorPhase {
  /// hold: stays where the needle is; wait: stays where the hand meant to be, pressing on.
  enum class Kind { advance, withdraw, hold, turn, let_go, wait };
  enum class Goal { depth, region, bone };
  Kind kind = Kind::hold;
  Goal goal = Goal::depth;
  double speed = 0;            ///< m/s, advance and withdraw
  double depth = 0;            ///< m along the line; for Goal::region how deep into it at least;
                               ///< for Goal::bone where to give up, 0: nowhere
  double before_floor = 0;     ///< m above the end of a layer that Goal::region stops at the
                               ///< latest, however deep it meant to go; 0: half way through
  bool keeps_depth = false;    ///< hold: where the tip is watched (OperatorView::depth) it is kept
                               ///< at `depth`, which it is waited for at the end
  bool stop_at_bone = false;   ///< advance: bone ends it, too
  RegionId region = kOutside;  ///< Goal::region
  double duration = 0;         ///< s; hold, turn, wait: exactly; others: at most
  Vec3 direction = Vec3::Zero();  ///< turn: the new line through the entry
  double thumb_force = 0;         ///< N that the thumb gives the plunger meanwhile; negative pulls
  double thumb_rate = 0;          ///< m^3/s that it means to give; 0: by force
  bool thumb_holds = false;       ///< it lets the plunger neither go on nor slide back
  bool until_flow = false;        ///< ends, too, when liquid flows out of the tip
  bool until_given = false;       ///< ends, too, when all that was meant has been given
  std::string label;              ///< of the moment when the phase ends; empty: none
};

/// Phases, in the words of an operator. Depths in m from the skin, speeds in m/s, times in s.
[[nodiscard]] OperatorPhase push_to(double depth, double speed);
[[nodiscard]] OperatorPhase pull_to(double depth, double speed);
[[nodiscard]] OperatorPhase stay(double duration);
[[nodiscard]] OperatorPhase press(double duration);
[[nodiscard]] OperatorPhase let_go(double duration);
[[nodiscard]] OperatorPhase aim(const Vec3& direction, double duration);

}  // namespace artus
