// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/operators/trajectory_forces.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "artus/detail/core/check.h"
#include "artus/haptics/needle_renderer.h"

namespace artus {

Result<std::vector<TrajectoryForce>> compute_trajectory_forces(
    const std::shared_ptr<const Scene>& scene, std::span<const Pose> X_JN, double rate,
    const std::string& device, const NeedleFeel& feel) {
  auto renderer = make_needle_renderer(scene, device, rate, feel);
  ARTUS_TRY(renderer);
  std::vector<TrajectoryForce> forces;
  forces.reserve(X_JN.size());
  for (std::size_t i = 0; i < X_JN.size(); ++i) {
    const RenderedNeedle& tick = (*renderer)->step({X_JN[i], static_cast<double>(i) / rate});
    const NeedleContact& contact = (*renderer)->model().contact();
    TrajectoryForce out;
    out.force = tick.command.force;
    out.torque = tick.command.torque;
    const bool felt = !tick.command.force.isZero(0);  // never where the pose is none
    out.axial = felt ? -tick.command.force.dot(X_JN[i].linear().col(2)) : 0;
    out.depth = contact.tick().depth;
    out.region = static_cast<std::uint16_t>(contact.region());
    out.contact = static_cast<std::uint16_t>(contact.state());
    out.status = tick.status;
    forces.push_back(out);
  }
  return forces;
}

std::vector<Pose> straight_insertion(const Vec3& entry, const Vec3& target, double speed,
                                     double rate, double above) {
  ARTUS_REQUIRE((target - entry).norm() > 1e-9, "entry and target are the same point");
  ARTUS_REQUIRE(speed > 0 && rate > 0, "speed and rate must be positive");
  const Vec3 axis = (target - entry).normalized();
  const double deepest = (target - entry).norm();
  const auto there = static_cast<std::size_t>(std::ceil((deepest + above) / speed * rate));
  std::vector<Pose> poses;
  poses.reserve(2 * there + 1);
  for (std::size_t i = 0; i <= 2 * there; ++i) {
    const std::size_t k = i <= there ? i : 2 * there - i;
    const double distance = std::min(deepest, static_cast<double>(k) * speed / rate - above);
    poses.push_back(make_pose(entry + distance * axis, axis, Vec3::Zero()));
  }
  return poses;
}

}  // namespace artus
