// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <memory>

#include "artus/detail/haptics/guard.h"
#include "artus/detail/haptics/probe/probe_contact.h"
#include "artus/detail/operators/hand_loop.h"

namespace artus {

/// A sonographer's hand with a probe: it steers the probe along the skin and leans on it with a
/// steady force.
struct ProbeHandParams {
  HandParams hand = {.stiffness = 1500,     // N/m
                     .damping = 80,         // N s/m
                     .mass = 0.3,           // kg, of hand and forearm's share
                     .turn_stiffness = 12,  // N m/rad
                     .turn_damping = 0.25,  // N m s/rad
                     .inertia = 3e-3};      ///< all assumed: a braced hand on a larger handle
  double press_force = 3;                   ///< N along the beam; assumed: a light scanning hand
  double standoff = 0.012;                  ///< m above the skin before and after
  DeviceLimits device{"probe", 40, 2, Vec3::Constant(1), 0.37, 2, 1e-6};  ///< moving mass of the
                                                                          ///< mock; rest assumed
  ProbeContactParams contact;  ///< of the rigid body's columns
  GuardParams guard;           ///< of the rigid body's
};

/// What the hand means to do at an instant.
struct ProbeIntention {
  Pose X_JP = Pose::Identity();  ///< where the face should be; its depth along z only when lifted
  double lift = 0;               ///< 0: leans on the skin; 1: held `standoff` and `rise` above X_JP
  double rise = 0;               ///< m
};

/// One tick of the probe hand. Frame J.
struct ProbeHandRow {
  Pose X_JP = Pose::Identity();    ///< as measured
  double normal_force = 0;         ///< N, of the tissue; no pull
  Vec3 edge_force = Vec3::Zero();  ///< N on the hand, of the tissue under the edges
  Vec3 friction = Vec3::Zero();    ///< N on the hand
  Vec3 torque = Vec3::Zero();      ///< N m on the hand
  double slip = 0;                 ///< m slid since the face touched
  double stiffness = 0;            ///< N/m, K_c, what the actuator has to render
  double indentation = 0;          ///< m, of the deepest column; 0 where tissue gives way
  double contact_share = 0;        ///< 0..1 of the face
  double energy_to_hand = 0;       ///< J given since the start
  std::uint32_t status = 0;        ///< TickStatus bits

  /// Where the picture of a rigid body is taken from: the tissue is not compressed in it, so the
  /// face is drawn back to where it meets the skin as it lies.
  [[nodiscard]] Pose image_pose() const;
};

/// The hand and the probe's moving mass in a closed loop with whatever presses back. Deterministic.
class ProbeHand {
 public:
  /// Starts at rest, `standoff` above `seat`. Requires: a rate that divides 20 kHz.
  ProbeHand(const ProbeHandParams& params, double rate_hz, const Pose& seat);

  [[nodiscard]] double time() const noexcept { return loop_.time(); }  ///< s
  [[nodiscard]] Pose measured() const noexcept { return loop_.measured(); }
  [[nodiscard]] double energy_to_hand() const noexcept { return loop_.energy_to_hand(); }  ///< J

  /// One haptic period in which the hand is given `felt`. `intend(t)`: a ProbeIntention.
  template <class Intend>
  void advance(const Wrench& felt, Intend intend) {
    loop_.advance(felt, [&](double t) { return lean(intend(t)); });
  }

 private:
  [[nodiscard]] Intention lean(const ProbeIntention& wanted) const;

  ProbeHandParams params_;
  HandLoop loop_;
};

/// The same on a body that does not give way: columns under the face answer, and a guard passes it
/// on.
class RigidProbeHand {
 public:
  /// As ProbeHand. Requires: a scene.
  RigidProbeHand(std::shared_ptr<const Scene> scene, const ProbeHandParams& params, double rate_hz,
                 const Pose& seat);

  /// One haptic period; the row is what was felt in it. `intend(t)`: a ProbeIntention.
  template <class Intend>
  ProbeHandRow step(Intend intend) {
    ProbeHandRow row = feel();
    hand_.advance(command_, intend);
    return row;
  }

 private:
  [[nodiscard]] ProbeHandRow feel();

  ProbeHand hand_;
  ProbeContactModel contact_;
  OutputGuard guard_;
  Wrench command_;
};

}  // namespace artus
