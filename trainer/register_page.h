// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <functional>
#include <optional>

#include "artus/core/result.h"
#include "artus/detail/exchange/touched_landmarks.h"
#include "artus/detail/exchange/tracker_calibration.h"
#include "artus/detail/viewer/pages/page.h"

namespace artus {

/// Where the needle is now, in the hands' own frame; nothing: not seen.
using SeenNeedle = std::function<std::optional<Pose>()>;

/// Leads a person from landmark to landmark until the hands' frame is known in the joint, and to
/// the place where a device lets a needle in: what was touched, how well it fits, what to do next.
/// `saved` gets what is known when someone saves. Returns whether it was saved. Errors: those of
/// the pages and of `saved`.
[[nodiscard]] Result<bool> lead_to_registration(
    PageWindow& pages, TouchedLandmarks& landmarks, const SeenNeedle& needle,
    const TrackerCalibration& calibration,
    const std::function<Result<void>(const TrackerCalibration&)>& saved, Language language);

}  // namespace artus
