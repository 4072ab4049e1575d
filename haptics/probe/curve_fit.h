// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include "artus/detail/haptics/probe/probe_packet.h"

namespace artus {

/// A face that presses, once the tissue has come to rest.
struct PressAtRest {
  Pose X_JP = Pose::Identity();
  Vec3 force = Vec3::Zero();   ///< N on the hand, axes of P
  Vec3 torque = Vec3::Zero();  ///< N m on the hand about the face's centre, axes of P
  double stiffness = 0;        ///< N/m along the face's axis; 0: not known
};

/// The curve by which the skin of `packet` answers as `press` says: its force along the axis, its
/// torques by the slopes of k, and its stiffness by b, from K d / F = z / (1 - e^-z), z = b d, over
/// all points. A press too light to tell keeps b, or all, of `before`. Cost: some 20 us.
[[nodiscard]] TissueCurve fit_curve(const ProbePacket& packet, const PressAtRest& press,
                                    const TissueCurve& before);

}  // namespace artus
