// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <vector>

#include "artus/detail/soft/solver/deformed_body.h"

namespace artus {

/// A layer below a probe: how thick it is at rest, and as the body now lies.
struct LayerBelow {
  RegionId region = kOutside;
  double rest = 0;  ///< m along the axis
  double now = 0;   ///< m between the same two points of the tissue

  [[nodiscard]] double thinned() const noexcept { return 1 - now / rest; }  ///< share of `rest`
};

/// The soft layers on the axis (z of P) of a face at `X_JP`, from the skin down to the first bone,
/// 60 mm at most. Requires: a pose from before the face was pressed in, at most 20 mm from the
/// skin. Cost: that of a Scene of the joint.
[[nodiscard]] std::vector<LayerBelow> layers_below(const DeformedBody& body, const Pose& X_JP);

}  // namespace artus
