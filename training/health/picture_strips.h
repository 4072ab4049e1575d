// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include "artus/echo/frame.h"

namespace artus {

/// How much of a picture is in vertical strips, as a share of it: windows of 5 mm of depth (every
/// 2.5 mm) by scanlines, in which the mean grey of a line differs by more than 3.5 dB from that of
/// the lines 0.3 mm beside it on both sides. Layers, speckle and slopes average out over the window
/// or go on across; an edge that throws a shadow counts, so that more than before tells of a broken
/// body. `pitch`: m between scanlines. Lines without contact, what is black and what lies nearer
/// than 1 mm is left out; 0 where nothing is left.
[[nodiscard]] double share_of_strips(const Frame& frame, double pitch);

}  // namespace artus
