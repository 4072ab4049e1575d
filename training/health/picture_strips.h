// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <vector>

#include "artus/echo/frame.h"

namespace artus {

/// How alike each scanline of a picture and the next are: the correlation of their greys over
/// depth, each smoothed along depth by half a millimetre (n_lines - 1). NaN where a line shows
/// nothing: no contact, or black all the way. `from` m: what lies nearer than that is left out.
[[nodiscard]] std::vector<double> neighbour_likeness(const Frame& frame, double from = 1e-3);

/// The share of scanlines that are far less like the next than the median, as where a picture is
/// cut into vertical strips: 1 - correlation above four times the median's, and above 0.2. 0 where
/// nothing is shown.
[[nodiscard]] double share_of_strips(const std::vector<double>& likeness);

}  // namespace artus
