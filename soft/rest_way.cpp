// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/soft/rest_way.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace artus {
namespace {

constexpr double kKnotPitch = 3e-4;    // m, knots that a bend asks for do not come closer
constexpr double kLeastStep = 5e-5;    // m, past a cube's face
constexpr double kOutsideStep = 3e-3;  // m, where there is no cube
constexpr double kOneStep = 3e-5;  // m off the tangent, four times the error half way; one Newton
                                   // step leaves next to nothing of it

constexpr int kFewSteps = 3;             // of Newton, then those that look closer
constexpr double kFolded = 0.02;         // of the volume
constexpr double kNearTangent = 8e-6;    // m off the tangent over more than a cube
constexpr double kFarthestAhead = 8e-3;  // m

}  // namespace

RestWay::RestWay(const DeformedBody& body, const Vec3& origin_J, const Vec3& direction_J) noexcept
    : body_(&body),
      R_JC_(body.map().X_JC.linear()),
      origin_J_(origin_J),
      direction_J_(direction_J),
      origin_C_(body.to_cage() * origin_J),
      direction_C_(body.to_cage().linear() * direction_J) {}

void RestWay::finish(RestKnot& knot) const noexcept {
  const Eigen::Matrix3d inverse_C = knot.gradient_C.inverse();
  knot.inverse_J.noalias() = R_JC_ * inverse_C * R_JC_.transpose();
  knot.onward_C.noalias() = inverse_C * direction_C_;
  knot.onward_J.noalias() = R_JC_ * knot.onward_C;
  const Vec3 moved = origin_C_ + knot.along * direction_C_ - knot.rest_C;
  knot.moved = moved.norm();
  knot.displacement_J.noalias() = R_JC_ * moved;
  knot.rest_J = origin_J_ + knot.along * direction_J_ - knot.displacement_J;
}

RestKnot RestWay::at(double along, const Vec3& guess_J) const noexcept {
  RestKnot knot;
  knot.along = along;
  const Vec3 p_C = origin_C_ + along * direction_C_;
  Vec3 guess_C = p_C - R_JC_.transpose() * guess_J;
  for (int k = 0; k < kFewSteps; ++k) {
    const DeformedBody::PlacedMotion there = body_->motion_in_cage(guess_C);
    const Vec3 error = p_C - guess_C - there.motion.displacement;
    const Eigen::Matrix3d& F = there.motion.gradient;
    if (!(F.determinant() > kFolded)) break;
    knot.rest_C = guess_C + F.inverse() * error;
    knot.gradient_C = F;
    knot.cell = there.cell;
    if (error.norm() < kOneStep) {
      finish(knot);
      return knot;
    }
    guess_C = knot.rest_C;
  }
  const DeformedBody::Rest rest = body_->to_rest(origin_J_ + along * direction_J_, guess_J);
  knot.rest_C = body_->to_cage() * rest.p_rest;
  const DeformedBody::PlacedMotion there = body_->motion_in_cage(knot.rest_C);
  knot.gradient_C = there.motion.gradient;
  knot.cell = there.cell;
  finish(knot);
  return knot;
}

/// How far the line goes on until it leaves the cube, m.
double RestWay::to_face(const RestKnot& left) const noexcept {
  if (left.cell < 0) return kOutsideStep;
  const Cage& cage = body_->map().model->cage();
  const CageCell& cell = cage.cells()[static_cast<std::size_t>(left.cell)];
  const Vec3 low = cage.low_corner(cell);
  const double edge = cage.edge(cell);
  double way = std::numeric_limits<double>::infinity();
  for (Eigen::Index k = 0; k < 3; ++k) {
    const double slope = left.onward_C[k];
    if (std::abs(slope) < 1e-9) continue;
    const double face = slope > 0 ? low[k] + edge : low[k];
    way = std::min(way, (face - left.rest_C[k]) / slope);
  }
  return std::clamp(way + 1e-6, kLeastStep, edge * 4);
}

RestKnot RestWay::next(const RestKnot& left) const noexcept {
  RestKnot knot;
  const double face = to_face(left);
  double step = face + left.ahead;
  while (true) {
    knot.along = left.along + step;
    const Vec3 guess = left.rest_C + step * left.onward_C;
    const DeformedBody::PlacedMotion there = body_->motion_in_cage(guess);
    const Vec3 error = origin_C_ + knot.along * direction_C_ - guess - there.motion.displacement;
    const double off = error.norm();
    if (off < (step > face ? kNearTangent : kOneStep)) {
      knot.rest_C = guess + there.motion.gradient.inverse() * error;
      knot.gradient_C = there.motion.gradient;
      knot.cell = there.cell;
      if (off < kNearTangent) knot.ahead = std::min(kFarthestAhead, std::max(face, 2 * left.ahead));
      finish(knot);
      return knot;
    }
    if (step <= 2 * kKnotPitch) return at(knot.along, R_JC_ * there.motion.displacement);
    step = step > face ? face : 0.5 * step;
  }
}

RestPoint RestWay::beside(const RestKnot& other, double along) const noexcept {
  RestPoint point;
  point.along = along;
  const Vec3 p_J = origin_J_ + along * direction_J_;
  const Vec3 off_J = p_J - other.rest_J - other.displacement_J;
  point.rest_J = other.rest_J + Vec3(other.inverse_J * off_J);
  point.onward_J.noalias() = other.inverse_J * direction_J_;
  point.moved = (p_J - point.rest_J).norm();
  return point;
}

RestKnot RestWay::knot_beside(const RestKnot& other, double along) const noexcept {
  RestKnot knot = other;
  static_cast<RestPoint&>(knot) = beside(other, along);
  knot.displacement_J = origin_J_ + along * direction_J_ - knot.rest_J;
  knot.rest_C += R_JC_.transpose() * (knot.rest_J - other.rest_J);
  knot.onward_C.noalias() = R_JC_.transpose() * knot.onward_J;
  knot.ahead = 0;
  return knot;
}

Vec3 RestWay::carried(const RestKnot& knot, const Vec3& v_J) const noexcept {
  const Vec3 v_C = R_JC_.transpose() * v_J;
  return R_JC_ * Vec3(knot.gradient_C * v_C);
}

}  // namespace artus
