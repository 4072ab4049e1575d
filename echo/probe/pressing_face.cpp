// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/echo/probe/pressing_face.h"

#include <algorithm>
#include <cmath>

namespace artus {

Result<ProbeFace> pressing_face(const Transducer& transducer) {
  if (transducer.radius > 0)
    return fail(ErrorCode::unsupported, "only a straight probe can be pressed", "transducer");
  ProbeFace face;
  const double spacing = face.length / face.points_x;
  face.length = transducer.width;
  face.points_x = std::max(1, static_cast<int>(std::lround(transducer.width / spacing)));
  return face;
}

}  // namespace artus
