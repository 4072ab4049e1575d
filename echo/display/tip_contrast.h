// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <optional>

#include "artus/echo/frame.h"
#include "artus/echo/transducer.h"

namespace artus {

/// dB by which the envelope in the disc of 1.5 mm diameter around (x, z), m, frame P, stands above
/// the ring of 2 to 4 mm around it (root mean square of each); empty when the place is off the
/// lines. Requires: the transducer of the frame. Cost: linear in the needle's samples.
[[nodiscard]] std::optional<double> tip_contrast(const Frame& frame, const Transducer& transducer,
                                                 double x, double z) noexcept;

/// The same where the needle's tip shows; empty where nothing of it does.
[[nodiscard]] std::optional<double> tip_contrast(const Frame& frame,
                                                 const Transducer& transducer) noexcept;

}  // namespace artus
