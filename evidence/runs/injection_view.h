// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include "artus/core/geometry.h"
#include "artus/echo/transducer.h"
#include "artus/raycast/scene.h"

namespace artus {

/// Where a probe lies, and how well it sees the tip.
struct FoundView {
  Pose X_JP = Pose::Identity();
  double merit = 0;  ///< 0: not at all; about 3: the whole face on the skin, nothing hides the tip
};

/// How closely it is searched.
enum class ViewSearch { fine, coarse };

/// Where a probe of `width` m lies on the skin to see the needle's tip, the needle in its plane:
/// the joint's own way of looking, turned to the needle, or a better one. Better is, in this order
/// of weight: that the tip is seen at all, more of the face on the skin, fewer beams beside the tip
/// that end in bone or leave from the air, a shorter way, a needle that runs across the beam.
/// Its lateral axis is that of the two that the joint's own probe pose is nearer to, so that left
/// and right are as in its other pictures. Deterministic. Cost: some ten thousand rays; coarse:
/// five hundred.
[[nodiscard]] FoundView find_view_of(const Scene& scene, const Pose& X_JN, double width,
                                     ViewSearch search = ViewSearch::fine);

/// The same probe where skin below its face has been lifted: moved back along its axis until no
/// skin stands in the face. At most 30 mm.
[[nodiscard]] Pose ride_on_skin(const Scene& body, Pose X_JP, const Transducer& transducer);

}  // namespace artus
