// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/soft/solver/press.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "artus/detail/core/check.h"
#include "artus/detail/core/csv.h"
#include "artus/detail/core/units.h"

namespace artus {
namespace {

constexpr double kStep = 1e-3;       // m
constexpr double kTolerance = 2e-6;  // m a node may still move
constexpr double kNear = 0.005;      // of the force asked for
constexpr int kMaxTries = 12;
constexpr int kMaxSteps = 100;  // to rest: some fifty where a face presses with 10 N

enum class Until { near, settled };

Press hold(SoftBody& body, const Pose& X_JP, double depth, Until until) {
  Press press;
  press.depth = depth;
  press.X_JP = X_JP;
  press.X_JP.translation() += depth * X_JP.linear().col(2);
  if (until == Until::settled) {
    press.settled = body.settle(press.X_JP, kTolerance, kMaxSteps);
  } else {
    body.solver().refresh();
    for (int k = 0; k < 2; ++k) body.step(press.X_JP, std::numeric_limits<double>::infinity());
  }
  press.short_of = body.solver().held_off();
  press.depth -= press.short_of;
  press.X_JP.translation() -= press.short_of * X_JP.linear().col(2);
  press.contact = body.force_J();
  press.normal_force = -press.contact.force.dot(X_JP.linear().col(2));
  return press;
}

/// Why a press as deep as may be does not give the force.
std::string too_soft(const SoftBody& body, const Press& press, double force) {
  constexpr double kFar = 40e-3;  // m: nothing holds what lies under the face
  const double held = body.distance_to_held();
  if (held > kFar)
    return "the body gives way as a whole: what holds it begins " +
           to_csv(std::round(held / kMillimetre)) +
           " mm from the face; give it bone nearer to the probe, or a [region_of_interest] that "
           "cuts it there";
  const std::string depth = to_csv(press.depth / kMillimetre) + " mm of press";
  if (press.normal_force < kNear * force)
    return "the face meets no tissue that gives way within " + depth +
           ": it must lie on the skin, and not within bone or in the air";
  return "the tissue does not hold " + to_csv(force) +
         " N: " + to_csv(std::round(press.normal_force / 1e-3) * 1e-3) + " N at " + depth;
}

}  // namespace

Press press_by(SoftBody& body, const Pose& X_JP, double depth) {
  for (double d = kStep; d < depth; d += kStep) static_cast<void>(hold(body, X_JP, d, Until::near));
  return hold(body, X_JP, depth, Until::settled);
}

Result<Press> press_with(SoftBody& body, const Pose& X_JP, double force, double max_depth) {
  ARTUS_REQUIRE(force > 0, "a force above zero");
  Press below = hold(body, X_JP, 0, Until::near);
  while (below.normal_force >= force && below.depth - kStep > -max_depth)
    below = hold(body, X_JP, below.depth - kStep, Until::near);
  Press above = below;
  while (above.normal_force < force) {
    if (above.depth + kStep > max_depth)
      return fail(ErrorCode::failed, too_soft(body, above, force));
    below = above;
    above = hold(body, X_JP, above.depth + kStep, Until::near);
  }
  // Secant steps between settled states; the first two are the depths on both sides.
  Press last = hold(body, X_JP, above.depth, Until::settled);
  Press best = hold(body, X_JP, 0.5 * (below.depth + above.depth), Until::settled);
  for (int k = 0; k < kMaxTries && std::abs(best.normal_force / force - 1) > kNear; ++k) {
    if (!last.settled && !best.settled) break;  // neither force means what a slope could be made of
    const double slope = (best.normal_force - last.normal_force) / (best.depth - last.depth);
    const double distance = std::clamp((force - best.normal_force) / slope, -kStep, kStep);
    if (!std::isfinite(distance)) break;
    last = best;
    best =
        hold(body, X_JP, std::clamp(best.depth + distance, -max_depth, max_depth), Until::settled);
  }
  if (std::abs(best.normal_force / force - 1) > kNear)
    return fail(ErrorCode::failed, "the tissue does not come to rest under the force asked for: " +
                                       std::to_string(best.normal_force) + " N at " +
                                       std::to_string(1e3 * best.depth) +
                                       " mm; a probe wholly on the skin presses steadily");
  return best;
}

}  // namespace artus
