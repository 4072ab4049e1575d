// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "artus/core/geometry.h"
#include "artus/core/result.h"
#include "artus/raycast/scene.h"
#include "artus/simulation/session_params.h"

namespace artus {

/// What a hand that holds the needle feels in one tick of a trajectory. Frame J.
struct TrajectoryForce {
  Vec3 force = Vec3::Zero();   ///< N, within the device's limits
  Vec3 torque = Vec3::Zero();  ///< N m
  double axial = 0;            ///< N along the needle, positive against insertion
  double depth = 0;            ///< m along the needle since the skin
  std::uint16_t region = 0;    ///< at the tip
  std::uint16_t contact = 0;   ///< ContactState
  std::uint32_t status = 0;    ///< TickStatus bits
};

/// The poses of one tick, frame J.
struct TrajectoryPose {
  Pose X_JN = Pose::Identity();
  std::optional<Pose> X_JP;  ///< none: the probe is lifted off
};

/// The needle led through poses, one a tick of the params' haptic rate: what a session says of the
/// same poses. Tissue gives way when `params.deform`. An invalid pose shows in the tick's
/// status. Errors: those of validate. Cost: some us a tick, and the tissue's steps.
[[nodiscard]] Result<std::vector<TrajectoryForce>> compute_trajectory_forces(
    const std::shared_ptr<const Scene>& scene, std::span<const TrajectoryPose> poses,
    const SessionParams& params);

/// Params of a trajectory: a device by name (device_table()), a rate in Hz, tissue that gives way
/// where the scene's joint can. Errors: not_found (device), invalid (rate).
[[nodiscard]] Result<SessionParams> trajectory_params(const Scene& scene, const std::string& device,
                                                      double rate, bool rigid);

/// Poses of a straight insertion, one a tick: from `above` m in front of `entry` to `target` and
/// back, at `speed` m/s. Requires: entry and target apart, speed and rate positive.
[[nodiscard]] std::vector<Pose> straight_insertion(const Vec3& entry, const Vec3& target,
                                                   double speed, double rate, double above = 5e-3);

}  // namespace artus
