// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "artus/detail/haptics/needle/needle_model.h"
#include "artus/detail/operators/operator_phase.h"
#include "artus/detail/operators/simulated_hand.h"

namespace artus {

/// What the operator sees of the tip on the echo image and feels of bone.
struct OperatorView {
  RegionId region = kOutside;   ///< of the tip; outside while the needle is
  double into_layer = -1;       ///< m, the tip beyond the beginning of its layer; < 0: not known
  double thickness = 0;         ///< m, of that layer along the line
  std::optional<double> depth;  ///< m of the tip along the line in the material, as the picture
                                ///< shows it; none: the hand goes by itself
  bool bone = false;            ///< pushes back with all it has
  bool flows = false;           ///< liquid out of the tip, as the plunger tells
  bool given = false;           ///< all that was meant
};
/// The view of someone to whom every component of the force is known.
[[nodiscard]] OperatorView view_of(const NeedleModel& model) noexcept;

/// Where the picture shows a structure along the needle that was planned at `planned` (m from the
/// skin, its middle): pressed, dragged and opened tissue has its layers elsewhere. Of several such
/// layers the nearest counts. nullopt: the needle is out, or the structure not on its line as far
/// as is seen.
[[nodiscard]] std::optional<ShaftLayer> layer_seen(const NeedleContact& contact, RegionId region,
                                                   double planned) noexcept;

/// What one injection's operator means to do: phases one after another along a line through the
/// entry point, watching the tip as on the echo image, and feeling for bone. The one state machine
/// of every simulated injection: in the medical test, in experiments, and as a session's device.
class InjectionOperator {
 public:
  /// `start_depth`: m along the line where the tip begins, negative outside. Requires: a unit
  /// direction.
  InjectionOperator(const Vec3& entry, const Vec3& direction, double start_depth,
                    std::vector<OperatorPhase> phases);

  /// Looks at the last tick; begins the next phase when the present one's goal is met. Returns the
  /// phase that ended in this call, or null.
  const OperatorPhase* observe(double time, const Pose& X_JN, const OperatorView& view) noexcept;
  /// From here on along another line through the entry point, to its depths. Requires: a unit
  /// direction, as many phases, a needle that is still outside.
  void aim_along(const Vec3& direction, std::vector<OperatorPhase> phases) noexcept {
    first_direction_ = direction_ = turn_from_ = direction;
    phases_ = std::move(phases);
  }
  /// From the first phase on, with the needle at its start again.
  void begin_again(double time) noexcept;

  [[nodiscard]] Pose start() const noexcept;  ///< X_JN before the first phase
  [[nodiscard]] std::size_t phase() const noexcept { return index_; }
  [[nodiscard]] bool done() const noexcept { return index_ >= phases_.size(); }
  /// What is being done; null when all is.
  [[nodiscard]] const OperatorPhase* present() const noexcept {
    return done() ? nullptr : &phases_[index_];
  }
  [[nodiscard]] bool timed_out() const noexcept { return timed_out_; }
  /// What the hand wants at `t`, s, within the tick after the last observe().
  [[nodiscard]] Intention intention(double t) const noexcept;

 private:
  [[nodiscard]] bool goal_met(const OperatorPhase& phase, double time, double depth,
                              const OperatorView& view) noexcept;
  [[nodiscard]] bool bone_felt(double time, bool now) noexcept;
  void begin_phase(double time, double depth) noexcept;
  void keep_depth(double too_deep, double since) noexcept;

  Vec3 entry_;
  Vec3 first_direction_;
  double start_depth_;  // m
  Vec3 direction_;      // of the line now
  Vec3 turn_from_;      // direction at the start of a turn
  Vec3 x_hint_;
  double reference_;  // m along the line at phase_time_
  double phase_time_ = 0;
  double last_time_ = 0;   // s, of the newest observe()
  double bone_time_ = -1;  // s, since when the bone's full force is felt
  std::vector<OperatorPhase> phases_;
  std::size_t index_ = 0;
  bool started_ = false;
  bool timed_out_ = false;
};

}  // namespace artus
