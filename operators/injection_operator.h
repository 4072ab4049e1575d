// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "artus/haptics/needle/needle_model.h"
#include "artus/operators/simulated_hand.h"

namespace artus {

/// One thing the simulated operator does with the needle.
struct OperatorPhase {
  enum class Kind { advance, withdraw, hold, turn, let_go, wait_outside };
  enum class Goal { depth, region, bone };
  Kind kind = Kind::hold;
  Goal goal = Goal::depth;
  double speed = 0;               ///< m/s, advance and withdraw
  double depth = 0;               ///< m along the line; for Goal::region how deep into it at least
  RegionId region = kOutside;     ///< Goal::region
  double duration = 0;            ///< s; hold, turn: exactly; others: at most
  Vec3 direction = Vec3::Zero();  ///< turn: the new line through the entry
  std::string label;              ///< of the moment when the phase ends; empty: none
};

/// What one injection's operator means to do: phases one after another along a line through the
/// entry point, watching the tip as on the echo image, and feeling for bone.
class InjectionOperator {
 public:
  /// Requires: a unit direction; `turn_about`: the needle's x axis hint.
  InjectionOperator(const Vec3& entry, const Vec3& direction, double start_depth,
                    std::vector<OperatorPhase> phases);

  /// Looks at the last tick; begins the next phase when the present one's goal is met. Returns the
  /// phase that ended in this call, or null.
  const OperatorPhase* observe(double time, const Pose& X_JN, const NeedleModel& model);

  [[nodiscard]] bool done() const noexcept { return index_ >= phases_.size(); }
  [[nodiscard]] bool timed_out() const noexcept { return timed_out_; }
  /// What the hand wants at `t`, s, within the tick after the last observe().
  [[nodiscard]] Intention intention(double t) const noexcept;

 private:
  [[nodiscard]] bool goal_met(const OperatorPhase& phase, double time, double depth,
                              const NeedleModel& model);
  void begin_phase(double time, double depth);

  Vec3 entry_;
  Vec3 direction_;  // of the line now
  Vec3 turn_from_;  // direction at the start of a turn
  Vec3 x_hint_;
  double reference_;  // m along the line at phase_time_
  double phase_time_ = 0;
  double bone_time_ = -1;  // s, since when the bone's full force is felt
  std::vector<OperatorPhase> phases_;
  std::size_t index_ = 0;
  bool started_ = false;
  bool timed_out_ = false;
};

}  // namespace artus
