// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/soft/rest_way.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace artus {
namespace {

constexpr double kKnotPitch = 3e-4;       // m, knots that a bend asks for do not come closer
constexpr double kLeastStep = 5e-5;       // m, past a cube's face
constexpr double kLeastLayerStep = 1e-5;  // m, past a layer's border within a cube
constexpr double kOutsideStep = 3e-3;     // m, where there is no cube
constexpr double kOneStep = 3e-5;  // m off the tangent, four times the error half way; one Newton
                                   // step leaves next to nothing of it

constexpr double kNearTangent = 8e-6;    // m off the tangent over more than a cube
constexpr double kFarthestAhead = 8e-3;  // m

}  // namespace

RestWay::RestWay(const DeformedBody& body, const Vec3& origin_J, const Vec3& direction_J) noexcept
    : body_(&body),
      origin_J_(origin_J),
      direction_J_(direction_J),
      origin_C_(body.to_cage() * origin_J),
      direction_C_(body.to_cage().linear() * direction_J) {}

void RestWay::finish(RestKnot& knot) const noexcept {
  const Pose& X_JC = body_->map().X_JC;
  knot.inverse_C = knot.gradient_C.inverse();
  knot.onward_C = knot.inverse_C * direction_C_;
  knot.onward_J = X_JC.linear() * knot.onward_C;
  const Vec3 moved = origin_C_ + knot.along * direction_C_ - knot.rest_C;
  knot.moved = moved.norm();
  knot.displacement_J = X_JC.linear() * moved;
  knot.rest_J = origin_J_ + knot.along * direction_J_ - knot.displacement_J;
}

RestKnot RestWay::at(double along, const Vec3& guess_J) const noexcept {
  RestKnot knot;
  knot.along = along;
  const DeformedBody::Rest rest = body_->to_rest(origin_J_ + along * direction_J_, guess_J);
  knot.rest_C = body_->to_cage() * rest.p_rest;
  const DeformedBody::PlacedMotion there = body_->motion_in_cage(knot.rest_C);
  knot.gradient_C = there.motion.gradient;
  knot.cell = there.cell;
  finish(knot);
  return knot;
}

/// Whether the line meets cubes of several tissues between two ways from the left knot, m: there it
/// bends and comes back.
bool RestWay::meets_layers(const RestKnot& left, double from, double to) const noexcept {
  const Cage& cage = body_->map().model->cage();
  for (const double way : {from + kLeastStep, 0.5 * (from + to), to}) {
    if (body_->layers().layered(cage.cell_around(left.rest_C + way * left.onward_C))) return true;
  }
  return false;
}

/// How far the line goes on until it leaves the cube or, where several tissues share one, bends, m.
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
  if (!body_->layers().layered(left.cell)) return std::clamp(way + 1e-6, kLeastStep, edge * 4);
  const double slope = left.onward_C.z();
  if (std::abs(slope) > 1e-9) {
    const double level =
        body_->layers().next_bend(left.cell, (left.rest_C.z() - low.z()) / edge, slope > 0);
    way = std::min(way, (low.z() + level * edge - left.rest_C.z()) / slope);
  }
  return std::clamp(way + 1e-6, kLeastLayerStep, edge * 4);
}

RestKnot RestWay::next(const RestKnot& left) const noexcept {
  RestKnot knot;
  const double face = to_face(left);
  double step = face + left.ahead;
  if (left.ahead > 0 && meets_layers(left, face, step)) step = face;
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
      if (off < kNearTangent && !body_->layers().layered(left.cell))
        knot.ahead = std::min(kFarthestAhead, std::max(face, 2 * left.ahead));
      finish(knot);
      return knot;
    }
    if (step <= 2 * kKnotPitch)
      return at(knot.along, body_->map().X_JC.linear() * there.motion.displacement);
    step = step > face ? face : 0.5 * step;
  }
}

RestKnot RestWay::beside(const RestKnot& other, double along) const noexcept {
  RestKnot knot = other;
  knot.along = along;
  const Eigen::Matrix3d R = body_->map().X_JC.linear();
  const Vec3 p_J = origin_J_ + along * direction_J_;
  const Vec3 off_C = R.transpose() * (p_J - other.rest_J - other.displacement_J);
  const Vec3 rest_off_C = other.inverse_C * off_C;
  knot.rest_C += rest_off_C;
  knot.rest_J += R * rest_off_C;
  knot.displacement_J = p_J - knot.rest_J;
  knot.moved = knot.displacement_J.norm();
  knot.onward_C = other.inverse_C * direction_C_;
  knot.onward_J = R * knot.onward_C;
  knot.ahead = 0;
  return knot;
}

Eigen::Matrix3d RestWay::gradient_J(const RestKnot& knot) const noexcept {
  const Eigen::Matrix3d R = body_->map().X_JC.linear();
  return R * knot.gradient_C * R.transpose();
}

}  // namespace artus
