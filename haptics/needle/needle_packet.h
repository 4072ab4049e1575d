// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>

#include "artus/detail/soft/solver/needle_compliance.h"

namespace artus {

/// What the tissue around a needle is like, from one update of the body to the next. Plain numbers:
/// handed from thread to thread, and recorded.
struct NeedlePacket {
  std::array<double, 3> carried{};  ///< m, frame J: how far the tissue at the tip is from its rest,
                                    ///< without what the needle itself pushed it
  NeedleCompliance compliance;      ///< along the track; no points: the tissue is rigid to it
  double compliance_scale = 1;  ///< 0 to 1: of the displacement that the compliance says, what the
                                ///< tissue at the tip goes: pressed far it is stiffer
};

}  // namespace artus
