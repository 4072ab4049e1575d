// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "artus/core/result.h"
#include "artus/detail/anatomy/import/label_volume.h"

namespace artus {

/// Where the body ends, and by what that is known.
struct BodyOutline {
  std::string by;          ///< "label 'body_trunc'", "the image", "a hull around all labels"
  bool assumed = false;    ///< made, not measured
  std::uint16_t rest = 0;  ///< the label that was given to what no structure claims
};

/// Says which segments are what, by their place.
struct SegmentRoles {
  std::vector<bool> is_outline;  ///< the outline of all of the body
  std::vector<bool> is_skin;
  std::vector<bool> is_left_out;
};

/// Gives all of the body that no structure claims a label of its own, the last one (it is added to
/// the segments as "rest"): within the labels that outline the body; else within the skin; else
/// within `image` (CT: above -400 HU, else above Otsu's threshold; largest part, filled); else
/// within a hull around all labels (closed over 16 mm, 8 mm of fat). Voxels of outline labels and
/// left out ones become part of it. Errors: invalid (an image of another grid; nothing beside the
/// body, so that it has no skin). Cost: linear.
/// Source: [Otsu1979]; assumed: the threshold of -400 HU, half way from air to fat.
[[nodiscard]] Result<BodyOutline> outline_body(LabelVolume& volume, const SegmentRoles& roles,
                                               const std::optional<ImageVolume>& image,
                                               const std::string& name);

}  // namespace artus
