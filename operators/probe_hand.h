// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <memory>
#include <optional>

#include "artus/detail/haptics/guard.h"
#include "artus/detail/haptics/probe/probe_contact.h"
#include "artus/detail/haptics/probe/probe_tangent.h"
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
  GuardParams guard;
  double packet_rate = 0;  ///< 1/s of the tissue's answers (ProbeHand::take), which are then felt
                           ///< instead of columns; 0: the body is rigid
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

/// The hand, the probe's moving mass and the contact's force in a closed loop. Deterministic.
class ProbeHand {
 public:
  /// Starts at rest, `standoff` above `seat`. Requires: a scene, a rate that divides 20 kHz.
  ProbeHand(std::shared_ptr<const Scene> scene, const ProbeHandParams& params, double rate_hz,
            const Pose& seat);

  /// What the tissue answers from the next tick on, of a hand with a packet_rate.
  void take(const ProbePacket& packet) noexcept;

  /// One haptic period; the row is what was felt in it. `intend(t)`: a ProbeIntention.
  template <class Intend>
  ProbeHandRow step(Intend intend) {
    ProbeHandRow row = feel();
    loop_.advance(command_, [&](double t) { return lean(intend(t)); });
    return row;
  }

 private:
  [[nodiscard]] ProbeHandRow feel();
  void feel_columns(ProbeHandRow& row);
  void feel_tissue(ProbeHandRow& row);
  [[nodiscard]] Intention lean(const ProbeIntention& wanted) const;

  ProbeHandParams params_;
  HandLoop loop_;
  ProbeContactModel contact_;
  std::optional<ProbeTangent> tissue_;  // empty: the body is rigid
  double tissue_stiffness_ = 0;         // N/m along the beam, of the newest packet
  OutputGuard guard_;
  Wrench command_;
};

}  // namespace artus
