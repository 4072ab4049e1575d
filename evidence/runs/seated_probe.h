// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <optional>
#include <vector>

#include "artus/detail/evidence/runs/three_injections.h"
#include "artus/detail/simulation/tissue_packet.h"

namespace artus {

/// The hand with the probe in a run in tissue that gives way, tick by tick beside the needle's. The
/// probe goes where the operator means to have it next, from seat to seat, slid over the skin, or
/// lifted where that is beyond what a cage of the tissue reaches.
class SeatedProbe {
 public:
  /// `seats`: in the order of what is planned. Requires: one.
  SeatedProbe(const ProbeHandParams& params, double rate_hz, std::vector<Pose> seats);

  /// A moment at `time`, s. `planned`: the operator had a name for it, and goes on to the next;
  /// otherwise it was met on the way. Returns where the probe is meant to be at it.
  Pose reach(double time, bool planned);

  /// What the device says of it in the next tick; none while it is carried to another seat.
  [[nodiscard]] std::optional<Pose> held() const;
  /// What came of it; hand and device go on for a period.
  [[nodiscard]] ProbeHandRow feel(const DeviceFeedback& feedback);
  /// What the tissue answers from the next tick on.
  void take(const TissuePacket& packet) noexcept;

 private:
  [[nodiscard]] ProbeIntention intend(double t) const;

  std::vector<Pose> seats_;
  std::size_t next_ = 0;
  std::vector<NamedMoment> known_;  // so far, and the one that is meant to be next
  double stiffness_ = 0;            // N/m along the beam, of the newest packet
  ProbeHand hand_;
};

}  // namespace artus
