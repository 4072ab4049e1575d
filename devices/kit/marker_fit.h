// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <vector>

#include "artus/core/result.h"
#include "artus/detail/devices/kit/body_pose.h"

namespace artus::kit {

/// A body whose markers are where they were glued, not where they were drawn.
struct MarkerFit {
  MarkerBody body;
  double before = 0;  ///< pixels, rms with the markers as drawn
  double after = 0;   ///< pixels, rms
  double moved = 0;   ///< m, the farthest that a marker's middle went
};

/// From pictures while the body was turned before the camera for half a minute: alternating fits of
/// the poses and of the markers on the body, whose frame stays where the drawing has it in the
/// mean. Markers keep their size. Errors: invalid (fewer than 40 pictures with three markers and
/// more, a marker in fewer than 10 of them, a marker that went by more than 5 mm: another one was
/// glued there). Cost: some seconds for 300 pictures.
[[nodiscard]] Result<MarkerFit> fit_markers(const MarkerBody& drawn,
                                            const std::vector<std::vector<SeenMarker>>& pictures,
                                            const Lens& lens);

}  // namespace artus::kit
