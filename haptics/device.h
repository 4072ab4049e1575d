// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <string_view>

#include "artus/core/result.h"
#include "artus/detail/core/check.h"
#include "artus/detail/haptics/wrench.h"

namespace artus {

/// What a haptic device can render and sense. Source of the three real ones [Alamilla2020] table
/// 4.1; moving mass, damping and encoder step are assumed (makers' order of size), for simulation.
struct DeviceLimits {
  std::string_view name;
  double force = 0;               ///< N, peak
  double torque = 0;              ///< N m, peak; 0: rotations are sensed only
  Vec3 workspace = Vec3::Zero();  ///< m, edge lengths of the box (a cylinder's diameter twice)
  double mass = 0;                ///< kg, apparent at the tip
  double damping = 0;             ///< N s/m
  double encoder_step = 0;        ///< m at the tip
};

/// touch, virtuose_6d_desktop, delta, ideal.
[[nodiscard]] std::array<DeviceLimits, 4> device_table();

/// Errors: not_found, with the names there are.
[[nodiscard]] Result<DeviceLimits> find_device(std::string_view name);

/// The wrench scaled into the device's limits, force and torque each keeping its direction.
[[nodiscard]] ARTUS_REALTIME Wrench saturate(const DeviceLimits& device,
                                             const Wrench& wrench) noexcept;

}  // namespace artus
