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

FaceStress::FaceStress(std::shared_ptr<const DeformedBody> body, std::vector<PastContact> contacts)
    : body_(std::move(body)), contacts_(std::move(contacts)) {
  ARTUS_REQUIRE(body_ != nullptr, "a body is needed");
}

double FaceStress::operator()(const Vec3& p_rest) const noexcept {
  const Vec3 p = p_rest + body_->displacement(p_rest);
  double stress = 0;
  for (const auto& [share, contact] : contacts_) {
    const double rise = std::sqrt(contact.piece_area / std::numbers::pi);
    stress += share * stress_below(contact, rise, p);
  }
  return stress;
}

}  // namespace artus
