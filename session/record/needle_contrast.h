// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <optional>

#include "artus/detail/simulation/records.h"
#include "artus/echo/frame.h"
#include "artus/echo/transducer.h"

namespace artus {

/// dB by which the end of the needle stands out in a picture. A shaft along the plane is a line:
/// its last 5 mm, and the last 2 mm of them alone, as far as they show, beside lines that run along
/// them 1.2 to 2.9 mm away, in the mean of the dB that a screen shows; less 2 dB, by which the
/// brightest of a few such lines stands out of mere speckle. (A disc at the tip alone wavers by as
/// much as the echo is above muscle, and a bright layer beside it hides what everybody sees.) A
/// shaft that crosses the plane is a point: its disc of 1.5 mm beside the speckle whose median is
/// that of the ring of 2 to 4 mm. Empty where nothing of the tip shows. Requires: the frame of
/// `input`, by `transducer`. Cost: linear in the samples of a square of 15 mm, some 0.2 ms.
[[nodiscard]] std::optional<double> needle_contrast(const FrameInput& input, const Frame& frame,
                                                    const Transducer& transducer);

}  // namespace artus
