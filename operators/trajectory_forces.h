// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "artus/core/geometry.h"
#include "artus/core/result.h"
#include "artus/haptics/needle_feel.h"
#include "artus/raycast/scene.h"

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

/// The needle led through the poses `X_JN`, one a tick of `rate` Hz, under the laws of `feel`: the
/// same tick that a session runs. `device`: a name of device_table().
/// Errors: those of make_needle_renderer; a pose that is no pose shows in the tick's status.
/// Cost: some us a tick.
[[nodiscard]] Result<std::vector<TrajectoryForce>> compute_trajectory_forces(
    const std::shared_ptr<const Scene>& scene, std::span<const Pose> X_JN, double rate,
    const std::string& device = "ideal", const NeedleFeel& feel = {});

/// Poses of a straight insertion, one a tick: from `above` m in front of `entry` to `target` and
/// back, at `speed` m/s. Requires: entry and target apart, speed and rate positive.
[[nodiscard]] std::vector<Pose> straight_insertion(const Vec3& entry, const Vec3& target,
                                                   double speed, double rate, double above = 5e-3);

}  // namespace artus
