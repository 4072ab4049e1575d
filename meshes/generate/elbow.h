// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <vector>

#include "artus/detail/meshes/generate/solids/surfacing.h"

namespace artus {

/// The sizes of an elbow, m. All positions scale with `scale`; the thin layers keep their
/// thickness.
struct ElbowSize {
  double scale = 1;           ///< 1: a humerus 61 mm wide at the epicondyles
  double cartilage = 1.3e-3;  ///< on humerus, ulna and radial head
  double recess = 4.4e-3;     ///< posterior recess in the olecranon fossa, full as with an effusion
  double bursa = 0.9e-3;      ///< olecranon and radiohumeral bursa
};

/// The solids of a right elbow bent to a right angle, the thumb up: `body` (outer skin) first, then
/// the parts in the joint file's order of priority, in which they overlap. Frame J is centred
/// between capitellum and trochlea on the axis of bending, axes LPS (lateral is -x, the forearm
/// runs to -y), m. Requires: all sizes > 0.
[[nodiscard]] std::vector<Solid> make_elbow(const ElbowSize& size);

}  // namespace artus
