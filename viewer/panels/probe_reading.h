// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstdint>
#include <string>

#include "artus/detail/viewer/words/translation.h"
#include "artus/session/session.h"

namespace artus {

/// What is to be told of the hand that holds the probe, in one tick.
struct ProbeReading {
  bool felt = false;         ///< there is a probe, and the tissue gives way to it
  double force = 0;          ///< N, see press_of_probe
  double share = 0;          ///< of its face that presses, 0..1
  double tissue_age = 0;     ///< s, of the tissue that is felt
  std::uint32_t status = 0;  ///< TickStatus bits of its force
};

/// `params`: of the session.
[[nodiscard]] ProbeReading read_probe(const HapticSnapshot& now, const SessionParams& params);

/// "probe 3.2 N, 54 % of its face in contact, tissue 40 ms old", and why the force is held back,
/// when it is. Empty: not felt.
[[nodiscard]] std::string describe_probe(Language language, const ProbeReading& probe);

}  // namespace artus
