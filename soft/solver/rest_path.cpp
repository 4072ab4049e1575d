// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/soft/solver/rest_path.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace artus {
namespace {

constexpr double kKnotPitch = 3e-4;      // m, knots that a bend asks for do not come closer
constexpr double kMinStep = 5e-5;        // m, past a cube's face
constexpr double kMinLayerStep = 1e-5;   // m, past a layer's border within a cube
constexpr double kLayerTry = 2e-4;       // m that are worth a try where borders lie close
constexpr double kFarthestTry = 6e-4;    // m, the same where it went on straight: a thin layer and
                                         // the next may bend and bend back
constexpr double kOutsideStep = 3e-3;    // m, where there is no cube
constexpr double kFarthestFace = 48e-3;  // m
constexpr double kOneStep = 3e-5;  // m off the tangent, four times the error half way; one Newton
                                   // step leaves next to nothing of it

constexpr double kNearTangent = 8e-6;    // m off the tangent over more than a cube
constexpr double kFarthestAhead = 8e-3;  // m

}  // namespace

RestPath::RestPath(const DeformedBody& body, const Vec3& origin_J, const Vec3& direction_J) noexcept
    : body_(&body),
      origin_J_(origin_J),
      direction_J_(direction_J),
      origin_C_(body.to_cage() * origin_J),
      direction_C_(body.to_cage().linear() * direction_J) {}

void RestPath::finish(const Eigen::Matrix3d& gradient_C, RestKnot& knot) const noexcept {
  const Eigen::Matrix3d R = body_->map().X_JC.linear();
  const Eigen::Matrix3d inverse_C = gradient_C.inverse();
  knot.inverse_J = R * inverse_C * R.transpose();
  knot.onward_C = inverse_C * direction_C_;
  knot.onward_J = R * knot.onward_C;
  const Vec3 moved = origin_C_ + knot.along * direction_C_ - knot.rest_C;
  knot.moved = moved.norm();
  knot.displacement_J = R * moved;
  knot.rest_J = origin_J_ + knot.along * direction_J_ - knot.displacement_J;
}

RestKnot RestPath::at(double along, const Vec3& guess_J) const noexcept {
  RestKnot knot;
  knot.along = along;
  const DeformedBody::Rest rest = body_->to_rest(origin_J_ + along * direction_J_, guess_J);
  knot.rest_C = body_->to_cage() * rest.p_rest;
  const DeformedBody::PlacedMotion there = body_->motion_in_cage(knot.rest_C);
  knot.cell = there.cell;
  finish(there.motion.gradient, knot);
  return knot;
}

/// How far the line goes on until it leaves the part of a cube in which it does not bend, m.
double RestPath::to_face(const RestKnot& left) const noexcept {
  if (left.cell < 0) return kOutsideStep;
  const DeformedBody::Piece piece = body_->piece_around(left.rest_C, left.cell);
  double distance = std::numeric_limits<double>::infinity();
  for (Eigen::Index k = 0; k < 3; ++k) {
    const double slope = left.onward_C[k];
    if (std::abs(slope) < 1e-9) continue;
    const double face = slope > 0 ? piece.high[k] : piece.low[k];
    distance = std::min(distance, (face - left.rest_C[k]) / slope);
  }
  return std::clamp(distance + 1e-6, piece.whole ? kMinStep : kMinLayerStep, kFarthestFace);
}

/// Whether the line meets cubes of several tissues between two distances from the left knot, m:
/// there it bends and comes back.
bool RestPath::meets_layers(const RestKnot& left, double from, double to) const noexcept {
  const SoftModel& model = *body_->map().model;
  for (const double distance : {from + kMinStep, 0.5 * (from + to), to}) {
    if (model.layers().cuts(model.cage().cell_around(left.rest_C + distance * left.onward_C)))
      return true;
  }
  return false;
}

RestKnot RestPath::next(const RestKnot& left) const noexcept {
  RestKnot knot;
  const bool cut = body_->map().model->layers().cuts(left.cell);
  const double face = to_face(left);
  double step = face + (cut ? 0 : left.ahead);
  if (cut) {
    step = std::max(step, std::clamp(left.ahead, kLayerTry, kFarthestTry));
  } else if (left.ahead > 0 && meets_layers(left, face, step)) {
    step = face;
  }
  while (true) {
    knot.along = left.along + step;
    const Vec3 guess = left.rest_C + step * left.onward_C;
    const DeformedBody::PlacedMotion there = body_->motion_in_cage(guess);
    const Vec3 error = origin_C_ + knot.along * direction_C_ - guess - there.motion.displacement;
    const double off = error.norm();
    if (off < (step > face ? kNearTangent : kOneStep)) {
      knot.rest_C = guess + there.motion.gradient.inverse() * error;
      knot.cell = there.cell;
      if (off < kNearTangent)
        knot.ahead = cut ? 2 * step : std::min(kFarthestAhead, std::max(face, 2 * left.ahead));
      finish(there.motion.gradient, knot);
      return knot;
    }
    if (step <= 2 * kKnotPitch)
      return at(knot.along, body_->map().X_JC.linear() * there.motion.displacement);
    step = step > face ? face : 0.5 * step;
  }
}

}  // namespace artus
