// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <memory>
#include <vector>

#include "artus/detail/soft/solver/deformed_body.h"

namespace artus {

/// A probe's contact of some time, and how much of it counts.
struct PastContact {
  double share = 1;  ///< 0..1; of all together 1
  ContactForce contact;
};

/// What a probe's face puts on the tissue below it: the normal stress along the face's axis in an
/// elastic half space under the point forces of the pieces that press, sum of 3 F z^3 / (2 pi R^5)
/// whatever its stiffness ([Johnson1985] section 3.2). A piece acts from its own radius above the
/// face, so that none is a needle and every level below carries all of the force. Not modelled:
/// bone below, above which it is greater, and the softness of one layer against another's.
class FaceStress {
 public:
  /// The shares of `contacts` on the body as it is now. Requires: a body.
  FaceStress(std::shared_ptr<const DeformedBody> body, std::vector<PastContact> contacts);

  /// Pa on a material point of the body (rest, m, frame J), where that is now; 0 above the face.
  /// Cost: linear in the pieces.
  [[nodiscard]] double operator()(const Vec3& p_rest) const noexcept;

 private:
  std::shared_ptr<const DeformedBody> body_;
  std::vector<PastContact> contacts_;
};

/// The same below point forces on a plane, of a point now.
[[nodiscard]] double stress_below(const ContactForce& contact, double rise, const Vec3& p) noexcept;

}  // namespace artus
