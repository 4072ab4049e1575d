// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <span>

#include "artus/detail/evidence/runs/needle_trace.h"
#include "artus/haptics/device.h"

namespace artus {

/// What a needle does after the hand lets go.
struct Release {
  double from = 0;      ///< s, the fingers begin to open
  double open = 0;      ///< s, the first tick in which the hand's force is zero
  double moved = 0;     ///< m towards the skin since `from`, of the needle itself, at most
  double momentum = 0;  ///< m that the speed given by the hand carries the device alone, |v| m / b:
                        ///< the speed at `open` less what the force law has worked since `from`
  /// m beyond the momentum: what the force law did. A needle that is let go between two beats of a
  /// trembling hand goes on at that hand's speed with any law, also in free air.
  [[nodiscard]] double ejection() const noexcept { return moved > momentum ? moved - momentum : 0; }
};

/// Looks at the rows until `until`, s. `from`: s, when the fingers began to open. The needle moves
/// along +z into the body.
[[nodiscard]] Release measure_release(std::span<const NeedleRow> rows, double from, double until,
                                      const DeviceLimits& device);

}  // namespace artus
