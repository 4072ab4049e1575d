// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstdint>
#include <optional>

#include "artus/detail/operators/simulated_hand.h"

namespace artus {

/// How well two hands work together: errors of the published kinds. Values of the two ready ones
/// are assumed, chosen with the published results of novices and trained people in view.
struct OperatorSkill {
  double aim_sd = 2;            ///< deg, of the needle's direction about each axis
  double entry_sd = 1e-3;       ///< m, of the entry point
  double view_sd = 0.4e-3;      ///< m, of the probe's plane beside the intended one
  double view_turn_sd = 1;      ///< deg, of the plane's turn about the beam
  double see = 0.95;            ///< chance of noticing a visible tip at a glance (20 a second)
  double reaction = 0.2;        ///< s from seeing to doing
  double unseen_stop = 0.5e-3;  ///< m advanced unseen until the hand stops
  double advance_unseen = 0;    ///< chance to go on for 5 mm all the same
  double search_right = 0.95;   ///< chance that a search moves the probe the right way
  double drift = 0.1e-3;        ///< m/s of the probe while needling
  double follow = 4;            ///< 1/s, how fast the probe follows the needle's plane
  double judge_sd = 0.4e-3;     ///< m, of the distance that is judged left
  double correction = 3;        ///< deg/s of turning toward the target while the tip is seen
  double speed = 8e-3;          ///< m/s of advance
  double haste = 1;             ///< times the rate that is asked for, of the thumb
  double aspirate = 2.5;        ///< s that the thumb draws back before it gives
  double know = 0.95;           ///< chance of knowing a structure by its look when it comes in view
  double look = 0.95;           ///< chance of noticing that what is given runs elsewhere
  double feel = 1;              ///< chance of noticing a wall that has not given way, and that the
                                ///< thumb meets more than its liquid
  double tremor_rms = 20e-6;    ///< m an axis
};
[[nodiscard]] OperatorSkill expert_skill();
/// `trials`: that the novice has done; errors fall toward the expert's as (1 - 0.069)^n, the rate
/// of needle alignment derived from [Oliveira2008].
[[nodiscard]] OperatorSkill novice_skill(int trials = 0);

/// What two hands mean to do: where the needle goes in and should come, and the view.
struct ScanPlan {
  Vec3 entry = Vec3::Zero();     ///< m
  Vec3 target = Vec3::Zero();    ///< m
  Pose X_JP = Pose::Identity();  ///< view that shows both
  double time_limit = 180;       ///< s
  double appears = 0;            ///< m from the entry where the tip should come into the picture
};

/// What the eyes get at a glance.
struct ScanGlance {
  bool visible = false;       ///< the tip can be seen in the picture
  double offset = 0;          ///< m, of the tip from the plane: what a look at the hands tells
  double depth = 0;           ///< m, of the tip along its way from the entry
  Vec3 moved = Vec3::Zero();  ///< m, how the tissue at the target has moved: the picture shows it
                              ///< there
  bool stuck = false;         ///< something hard is felt
  bool tents = false;         ///< the tip pushes a wall before it that has not given way
  bool resists = false;       ///< the tissue takes what the thumb gives only by force
  bool astray = false;        ///< enough is given to be seen, and it does not run into the target
  bool given = true;          ///< all is given that was to be, or nothing was
};

/// Two simulated hands, one with the probe and one with the needle, that see the tip only when it
/// can be seen. Deterministic by seed; knows no clock but the times it is given.
class ScanningOperator {
 public:
  ScanningOperator(const OperatorSkill& skill, const ScanPlan& plan, std::uint64_t seed);

  /// A glance at the picture, 20 times a second. `X_JN`: where the needle is.
  void look(double time, const Pose& X_JN, const ScanGlance& glance);

  /// What the needle hand wants at `t`, s, until the next glance.
  [[nodiscard]] Intention intention(double t) const noexcept;
  /// Where the probe is held.
  [[nodiscard]] Pose probe(double t) const noexcept;
  /// The needle is where the hands mean it to be: they rest and inject.
  [[nodiscard]] bool holds() const noexcept { return phase_ == Phase::hold; }
  /// Meanwhile the thumb has let go at `t`, since too much pushed back.
  [[nodiscard]] bool eases(double t) const noexcept { return holds() && t < eases_until_; }
  [[nodiscard]] bool done() const noexcept { return phase_ == Phase::done; }

 private:
  enum class Phase { approach, advance, search, hold, withdraw, done };
  void begin(Phase phase, double time) noexcept;
  void advance(double time, const Pose& X_JN, const ScanGlance& glance, bool seen);
  void search(double time, const ScanGlance& glance, bool seen);
  void follow(double time, double offset);
  void correct(const Pose& X_JN);
  void hold(double time, const Pose& X_JN, const ScanGlance& glance, bool seen);
  [[nodiscard]] double draw() noexcept;
  [[nodiscard]] double gauss() noexcept;
  [[nodiscard]] double depth_meant(double t) const noexcept;

  OperatorSkill skill_;
  ScanPlan plan_;
  std::uint64_t seed_;
  std::uint64_t draws_ = 0;
  Phase phase_ = Phase::approach;
  double phase_time_ = 0;      // s
  double phase_distance_ = 0;  // m along the line when the phase began
  double speed_ = 0;           // m/s of it now
  Vec3 entry_ = Vec3::Zero();
  Vec3 direction_ = Vec3::UnitZ();
  Vec3 x_hint_ = Vec3::UnitX();
  double judged_ = 0;               // m, this attempt's bias of judged distance
  double seen_depth_ = 0;           // m, where the tip was last seen
  double seen_time_ = -1;           // s, since when it is seen
  std::optional<double> rested_;    // m along the line to the target, where the needle came to rest
  std::optional<bool> feels_tent_;  // that the target's wall has not given way; none: not yet met
  int nudges_ = 0;                  // that were made while injecting
  double eases_until_ = 0;          // s
  double bold_until_ = 0;           // m, depth to which the hand goes on unseen
  double plane_ = 0;                // m, of the probe beside its plan
  double plane_turn_ = 0;           // rad
  double drift_ = 0;                // m/s, signed
  double plane_speed_ = 0;          // m/s
  double plane_time_ = 0;           // s, when plane_ held
};

}  // namespace artus
