// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/viewer/panels/label_places.h"

#include <algorithm>

namespace artus {
namespace {

constexpr float kGap = 4;  // pixels between two names of one line

bool meet(const LabelBox& a, const LabelBox& b) noexcept {
  return a.x < b.x + b.width + kGap && b.x < a.x + a.width + kGap && a.y < b.y + b.height &&
         b.y < a.y + a.height;
}

}  // namespace

std::vector<std::optional<LabelBox>> place_labels(std::span<const LabelBox> requested, float width,
                                                  float height, int lines) {
  std::vector<std::optional<LabelBox>> placed;
  placed.reserve(requested.size());
  for (const LabelBox& request : requested) {
    std::optional<LabelBox> found;
    const bool fits = request.width <= width && request.height <= height;
    for (int step = 0; fits && !found && step <= 2 * lines; ++step) {
      const int up_or_down = step % 2 == 0 ? step / 2 : -(step + 1) / 2;
      LabelBox box = request;
      box.x = std::clamp(box.x, 0.F, width - box.width);
      box.y =
          std::clamp(box.y + static_cast<float>(up_or_down) * box.height, 0.F, height - box.height);
      const bool free = std::none_of(placed.begin(), placed.end(), [&box](const auto& other) {
        return other && meet(box, *other);
      });
      if (free) found = box;
    }
    placed.push_back(found);
  }
  return placed;
}

}  // namespace artus
