// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <optional>

#include "artus/echo/frame.h"
#include "artus/echo/transducer.h"

namespace artus {

/// How the tip stands out in one picture.
struct ImageSight {
  double time = 0;  ///< s
  bool visible = false;
  std::optional<double> contrast_db;  ///< disc over ring; empty where nothing of the tip shows
};

/// dB by which the envelope in the disc of 1.5 mm diameter where the tip shows stands above the
/// ring of 2 to 4 mm around it (root mean square of each); empty when the place is off the lines.
/// Requires: the transducer of the frame. Cost: linear in the needle's samples.
[[nodiscard]] std::optional<double> tip_contrast(const Frame& frame, const Transducer& transducer,
                                                 double x, double z) noexcept;
inline constexpr double kVisibleContrast = 6;  ///< dB

}  // namespace artus
