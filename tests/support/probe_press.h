// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cmath>
#include <cstdint>

#include "artus/detail/haptics/probe/probe_packet.h"

namespace artus::test {

/// A packet of flat skin `depth` m before a face at `X_JP`, which presses it with `force` N at
/// rest.
inline ProbePacket pressing_packet(const Pose& X_JP, double force, double depth = 3e-3,
                                   std::uint64_t number = 1) {
  ProbePacket packet;
  packet.number = number;
  for (Eigen::Index i = 0; i < 12; ++i)
    packet.X_JF[static_cast<std::size_t>(i)] = X_JP.matrix()(i / 4, i % 4);
  packet.z.fill(-depth);
  packet.spacing_x = packet.spacing_y = 5e-3;
  packet.length = 40e-3;
  packet.width = 6e-3;
  const double b = packet.curve.hardening;
  packet.curve.stiffness = force * b / std::expm1(b * depth);
  return packet;
}

}  // namespace artus::test
