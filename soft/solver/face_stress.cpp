// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/soft/solver/face_stress.h"

#include <cmath>
#include <numbers>
#include <utility>

#include "artus/detail/core/check.h"

namespace artus {

double stress_below(const ContactForce& contact, double rise, const Vec3& p) noexcept {
  double sum = 0;
  for (const PressingPiece& piece : contact.pieces) {
    const Vec3 offset = p - piece.p;
    const double depth = offset.dot(contact.into);
    if (!(depth > 0)) continue;
    const double z = depth + rise;
    const double aside = offset.squaredNorm() - depth * depth;
    const double square = aside + z * z;
    sum += piece.force * z * z * z / (square * square * std::sqrt(square));
  }
  return 1.5 / std::numbers::pi * sum;
}

FaceStress::FaceStress(std::shared_ptr<const DeformedBody> body) : body_(std::move(body)) {
  ARTUS_REQUIRE(body_ != nullptr, "a body is needed");
  rise_ = std::sqrt(body_->contact().piece_area / std::numbers::pi);
}

double FaceStress::operator()(const Vec3& p_rest) const noexcept {
  return stress_below(body_->contact(), rise_, p_rest + body_->displacement(p_rest));
}

}  // namespace artus
