// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/simulation/trajectory_forces.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "artus/detail/core/check.h"
#include "artus/simulation/simulation.h"

namespace artus {

Result<std::vector<TrajectoryForce>> compute_trajectory_forces(
    const std::shared_ptr<const Scene>& scene, std::span<const TrajectoryPose> poses,
    const SessionParams& params) {
  ARTUS_TRY(validate(params));
  Simulation simulation(scene, params);
  std::vector<TrajectoryForce> forces;
  forces.reserve(poses.size());
  for (const TrajectoryPose& pose : poses) {
    Hands hands;
    hands.X_WN = pose.X_JN;
    hands.X_WP = pose.X_JP;
    static_cast<void>(simulation.step(hands));
    const HapticSnapshot& tick = simulation.last();
    TrajectoryForce out;
    for (Eigen::Index i = 0; i < 3; ++i) {
      out.force[i] = tick.force_J[i];
      out.torque[i] = tick.torque_J[i];
    }
    const bool felt = !out.force.isZero(0);  // never where the pose is none
    out.axial = felt ? -out.force.dot(pose.X_JN.linear().col(2)) : 0;
    out.depth = tick.feedback.depth;
    out.region = static_cast<std::uint16_t>(tick.feedback.region);
    out.contact = static_cast<std::uint16_t>(tick.feedback.contact);
    out.status = tick.status;
    forces.push_back(out);
  }
  return forces;
}

Result<SessionParams> trajectory_params(const Scene& scene, const std::string& device, double rate,
                                        bool rigid) {
  SessionParams params;
  const auto limits = find_device(device);
  ARTUS_TRY(limits);
  params.device = *limits;
  params.haptic_rate = rate;
  params.deform = !rigid && gives_way(scene.joint());
  ARTUS_TRY(validate(params));
  return params;
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
