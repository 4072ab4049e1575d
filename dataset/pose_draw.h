// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "artus/detail/dataset/draw_ranges.h"
#include "artus/detail/dataset/frame_order.h"
#include "artus/echo/needle_view.h"
#include "artus/raycast/scene.h"

namespace artus {

/// What is not drawn, or drawn from: the patients, of which each is as likely, and the needle of a
/// frame whose ranges draw none.
struct DrawBase {
  std::vector<std::shared_ptr<const Scene>> patients;
  NeedleShape needle;
};

/// Frames drawn at random: number i depends on the base, ranges, seed and i alone, not on how many
/// there are or who asks. Requires: a patient. Cost: some us a frame.
[[nodiscard]] FrameSource drawn_frames(const DrawBase& base, const DrawRanges& ranges,
                                       std::uint64_t seed, std::size_t count);

}  // namespace artus
