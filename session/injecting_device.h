// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstdint>

#include "artus/detail/operators/injection_operator.h"
#include "artus/detail/simulation/simulated_hands.h"

namespace artus {

/// What a simulated person does with the needle, over and over: in along a line to the target, or
/// until bone stops it, a rest in which it may give something and waits until that is in, on to
/// bone, and out again. Frame W.
struct InjectionPlan {
  Vec3 entry_W = Vec3::Zero();       ///< m, on the skin
  Vec3 direction_W = Vec3::UnitZ();  ///< unit, into the body
  Pose X_WP = Pose::Identity();      ///< where the other hand holds the probe
  double target = 20e-3;             ///< m, depth of the tip where the hand rests
  double deepest = 40e-3;            ///< m, where it turns back when no bone is felt
  double speed = 10e-3;              ///< m/s, of the hand's intention
  double volume = 0;                 ///< m^3 that is given at the target, each time; 0: none
  double rate = 0.25e-6;             ///< m^3/s at which it means to
  PlungerParams plunger;             ///< that it knows, to stop before the mark
};

/// A simulated hand on a simulated device, closed loop: the force that artus sends moves the
/// needle, the hand pushes through a spring and feels bone as its own needle lagging behind. An
/// impedance device's mass and friction and the hand's tremor are in it (SimulatedHand,
/// SimulatedDevice). The same calls give the same samples.
class InjectingDevice final : public InputDevice {
 public:
  /// `rate_hz`: of the reads. Requires: a unit direction, target <= deepest, speed > 0.
  InjectingDevice(const InjectionPlan& plan, const DeviceLimits& device, double rate_hz,
                  const HandParams& hand = {});

  [[nodiscard]] ARTUS_REALTIME DeviceSample read(std::int64_t now_ns) noexcept override;
  ARTUS_REALTIME void write(const DeviceFeedback& feedback) noexcept override;
  [[nodiscard]] std::string_view name() const noexcept override { return "simulated hand"; }

  /// What the hand is about, in this order, again and again.
  enum class Phase : std::size_t { wait, to_target, rest, to_bone, press, withdraw };
  [[nodiscard]] Phase phase() const noexcept { return static_cast<Phase>(person_.phase()); }

 private:
  [[nodiscard]] OperatorView view(const DeviceFeedback& feedback) const noexcept;

  InjectionPlan plan_;
  InjectionOperator person_;
  SimulatedHands hands_;
};

}  // namespace artus
