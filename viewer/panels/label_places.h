// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <optional>
#include <span>
#include <vector>

namespace artus {

/// A rectangle of a picture that a name needs, pixels from the upper left.
struct LabelBox {
  float x = 0;  ///< left
  float y = 0;  ///< top
  float width = 0;
  float height = 0;
};

/// Where names stand so that none meets another and all lie within `width` x `height`: each as near
/// as may be to where it is wished, at most `lines` of its heights above or below; empty for a name
/// that has no room. The first come first. Cost: quadratic in the names.
[[nodiscard]] std::vector<std::optional<LabelBox>> place_labels(std::span<const LabelBox> requested,
                                                                float width, float height,
                                                                int lines = 2);

}  // namespace artus
