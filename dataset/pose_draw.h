// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "artus/detail/dataset/draw_ranges.h"
#include "artus/detail/dataset/frame_order.h"
#include "artus/echo/image_settings.h"
#include "artus/echo/needle_view.h"
#include "artus/echo/transducer.h"
#include "artus/raycast/scene.h"

namespace artus {

/// What is not drawn, or drawn from: the patients, of which each is as likely, the needle of a
/// frame whose ranges draw none, and the probes that the ranges name, or the one of all frames.
struct DrawBase {
  std::vector<std::shared_ptr<const Scene>> patients;
  NeedleShape needle;
  std::vector<Transducer> transducers{Transducer{}};
  ImageSettings settings{};
};

/// The names of `not_in` that no patient has as a tissue or structure.
[[nodiscard]] std::vector<std::string> unknown_places(const DrawBase& base,
                                                      const DrawRanges& ranges);

/// Frames drawn at random: number i depends on the base, ranges, seed and i alone, not on how many
/// there are or who asks. A needle that may not be where it was drawn is drawn again with its
/// probe; where two hundred draws do not find one, the frame has none. Requires: a patient, valid
/// transducers and settings. Cost: some us a draw, and 10 ms for each transducer once.
[[nodiscard]] FrameSource drawn_frames(const DrawBase& base, const DrawRanges& ranges,
                                       std::uint64_t seed, std::size_t count);

}  // namespace artus
