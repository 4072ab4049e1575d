// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "artus/anatomy/compiled_joint.h"
#include "artus/detail/haptics/probe/probe_packet.h"
#include "artus/detail/soft/solver/soft_body.h"

namespace artus {

/// The skin of a joint at rest, for what a probe's face lands on.
class SkinSurface {
 public:
  /// Requires: a joint that outlives this.
  explicit SkinSurface(const CompiledJoint& joint);

  /// Writes the heights of the skin before a face of this size at `X_JP` into `packet`, frame F
  /// being the face's: along its axis, within 60 mm of it, to 10 mm beyond its rim. Where a line
  /// meets no skin the nearest one goes on level; no slope is above 1. `rest_of`: as
  /// SoftBody::lift_skin. No skin near: spacings of 0. Cost: some 0.1 ms.
  void describe(const Pose& X_JP, double length, double width, const SoftBody::RestOf& rest_of,
                ProbePacket& packet) const;

 private:
  const CompiledJoint* joint_;
  std::vector<std::array<std::uint32_t, 3>> triangles_;  // right-hand normal out of the body
};

}  // namespace artus
