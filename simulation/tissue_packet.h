// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include "artus/detail/haptics/needle/needle_packet.h"
#include "artus/detail/haptics/probe/probe_packet.h"

namespace artus {

/// What the tissue of one image answers both hands with. Plain numbers.
struct TissuePacket {
  ProbePacket probe;  ///< its number is the packet's
  NeedlePacket needle;
};

}  // namespace artus
