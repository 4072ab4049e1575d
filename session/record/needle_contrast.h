// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <optional>

#include "artus/detail/simulation/records.h"
#include "artus/echo/frame.h"
#include "artus/echo/transducer.h"

namespace artus {

/// dB by which the envelope in the disc of 1.5 mm diameter where the needle's tip shows stands
/// above what is typical around it: the mean power of speckle whose median is that of the ring of 2
/// to 4 mm, less the strip of 1 mm to either side of the shaft's line. (The shaft would take the
/// contrast of its own tip, and a single bright strand that of all around it.) Empty where nothing
/// of the tip shows. Requires: the frame of `input`, by `transducer`. Cost: linear in the samples
/// of a square of 8 mm, some 0.1 ms.
[[nodiscard]] std::optional<double> needle_contrast(const FrameInput& input, const Frame& frame,
                                                    const Transducer& transducer);

}  // namespace artus
