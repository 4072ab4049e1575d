// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstdint>
#include <optional>

#include "artus/detail/haptics/probe/probe_packet.h"
#include "artus/detail/haptics/wrench.h"

namespace artus {

/// How tissue lags behind its curve: two arms of the standard solid, each a share of the curve's
/// force that fades. Passive for a force that rises with depth, whatever the packets' delay.
struct SkinContactParams {
  double tick_rate = 1000;  ///< Hz
  double friction = 0.05;   ///< Coulomb coefficient of the face on the skin
  double slow = 1;          ///< of the curve's force, fades in `slow_time`; assumed
  double slow_time = 0.05;  ///< s, the tissue's own; as SoftSolverParams::relaxation
  double fast = 0.6;        ///< of the curve's force, fades in `fast_time`: damps the hand; assumed
  double fast_time = 6e-3;  ///< s
  double correction_time = 0.08;  ///< s in which what a packet says anew is felt
  double correction_slew = 20;    ///< N/s that it may change the force by
  double bleed = 5e-3;            ///< W that corrections may give the hand at any time
  double tank = 2e-3;             ///< J that they may give at once, of what the tissue swallowed
  double late_after = 0.1;        ///< s; older tissue is not learned from: skin and curve stand
};

/// The probe's force at the tick's rate. The tick owns the contact: where the face meets the skin
/// is decided here, each tick, from the newest packet's skin; what packets change is felt slowly
/// and paid for, so that a late answer gives the hand no energy. The force is the gradient of an
/// energy that hangs on the face's place alone, less what fades with time; it acts nowhere off the
/// skin. One instance per probe; not thread safe; deterministic. Sources: the standard solid
/// [Fung1993]; energy accounts [Hannaford2002].
class SkinContact {
 public:
  /// Requires: rates and times above 0, shares and friction not negative.
  explicit SkinContact(const SkinContactParams& params);

  /// From the next tick on. A packet with a number that cannot be is left out.
  ARTUS_REALTIME void take(const ProbePacket& packet) noexcept;

  /// Force and torque on the hand at the face's centre, frame J; `tick`: its number. Without a
  /// probe, without a packet and off the skin: zero. Cost: some us.
  ARTUS_REALTIME const Wrench& step(const std::optional<Pose>& X_JP, std::uint64_t tick) noexcept;

  /// Of the face that presses, as last felt; 0 only where no force is.
  [[nodiscard]] double share() const noexcept { return share_; }
  /// s, of the tissue that the last tick felt; 0: there is none.
  [[nodiscard]] double age() const noexcept { return age_; }
  [[nodiscard]] bool late() const noexcept { return age_ > params_.late_after; }

 private:
  using Row = FaceDepths::Row;
  [[nodiscard]] Row felt_depth(const Row& offset) const noexcept;
  void start(const Pose& X_JP) noexcept;
  void learn(double share) noexcept;
  void press(const Pose& X_JP) noexcept;
  void add_friction(const Pose& X_JP, double normal) noexcept;

  SkinContactParams params_;
  double dt_;
  double slow_step_;  // of a tick, of what has faded
  double fast_step_;
  ProbePacket packet_;
  TissueCurve curve_;  // as felt now
  FaceDepths face_;
  Row offset_ = Row::Zero();  // m, of the depth as felt, from packets before
  Row slow_ = Row::Zero();    // N, force that the arm has forgotten
  Row fast_ = Row::Zero();
  std::optional<Pose> X_JP_;  // of the last tick
  std::optional<Vec3> grip_;  // m, frame J: where the skin holds the face's centre
  Eigen::Matrix3d R_JF_ = Eigen::Matrix3d::Identity();
  bool entering_ = false;  // the face came from nowhere and is not felt in full yet
  double tank_ = 0;        // J
  double age_ = 0;
  double share_ = 0;
  Wrench out_;
};

}  // namespace artus
