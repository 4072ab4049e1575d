// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <memory>

#include "artus/detail/soft/solver/deformed_body.h"

namespace artus {

/// What a probe's face puts on the tissue below it: the normal stress along the face's axis in an
/// elastic half space under the point forces of the pieces that press, sum of 3 F z^3 / (2 pi R^5)
/// whatever its stiffness ([Johnson1985] section 3.2). A piece acts from its own radius above the
/// face, so that none is a needle and every level below carries all of the force. Not modelled:
/// bone below, above which it is greater, and the softness of one layer against another's.
class FaceStress {
 public:
  /// Of the pieces that press the body now. Requires: a body.
  explicit FaceStress(std::shared_ptr<const DeformedBody> body);

  /// Pa on a material point of the body (rest, m, frame J), where that is now; 0 above the face.
  /// Cost: linear in the pieces.
  [[nodiscard]] double operator()(const Vec3& p_rest) const noexcept;

 private:
  std::shared_ptr<const DeformedBody> body_;
  double rise_;  // m that the pieces act from above the face
};

/// The same below point forces on a plane, of a point now.
[[nodiscard]] double stress_below(const ContactForce& contact, double rise, const Vec3& p) noexcept;

}  // namespace artus
