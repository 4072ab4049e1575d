// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/soft/press.h"

#include <algorithm>
#include <cmath>

#include "artus/core/check.h"

namespace artus {
namespace {

constexpr double kStep = 1e-3;       // m
constexpr double kTolerance = 2e-6;  // m a node may still move
constexpr double kNear = 0.005;      // of the force asked for
constexpr int kMostTries = 12;

Press hold(SoftBody& body, const Pose& X_JP, double depth) {
  Press press;
  press.depth = depth;
  press.X_JP = X_JP;
  press.X_JP.translation() += depth * X_JP.linear().col(2);
  press.settled = body.settle(press.X_JP, kTolerance, 40);
  press.contact = body.force_J();
  press.normal_force = -press.contact.force.dot(X_JP.linear().col(2));
  return press;
}

}  // namespace

Press press_by(SoftBody& body, const Pose& X_JP, double depth) {
  for (double d = kStep; d < depth; d += kStep) static_cast<void>(hold(body, X_JP, d));
  return hold(body, X_JP, depth);
}

Result<Press> press_with(SoftBody& body, const Pose& X_JP, double force, double most_depth) {
  ARTUS_REQUIRE(force > 0, "a force above zero");
  Press below = hold(body, X_JP, 0);
  Press above = below;
  while (above.normal_force < force) {
    if (above.depth + kStep > most_depth)
      return fail(ErrorCode::failed, "the tissue does not hold the force asked for: " +
                                         std::to_string(above.normal_force) + " N at the most");
    below = above;
    above = hold(body, X_JP, above.depth + kStep);
  }
  Press best = above;
  for (int k = 0; k < kMostTries && std::abs(best.normal_force / force - 1) > kNear; ++k) {
    const double share = std::clamp(
        (force - below.normal_force) / std::max(above.normal_force - below.normal_force, 1e-9),
        0.05, 0.95);
    best = hold(body, X_JP, below.depth + share * (above.depth - below.depth));
    (best.normal_force < force ? below : above) = best;
  }
  return best;
}

}  // namespace artus
