// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <filesystem>
#include <limits>
#include <string>
#include <string_view>

#include "artus/core/result.h"
#include "artus/detail/core/check.h"
#include "artus/detail/haptics/wrench.h"

namespace artus {

/// What a haptic device can render and sense. Source of the three real ones [Alamilla2020] table
/// 4.1; moving mass, damping and encoder step are assumed (makers' order of size), for simulation.
/// The probe's hand has limits of its own: a second device of the same kind, unless they are set.
struct DeviceLimits {
  std::string name;
  double force = 0;               ///< N, peak
  double torque = 0;              ///< N m, peak; 0: rotations are sensed only
  Vec3 workspace = Vec3::Zero();  ///< m, edge lengths of the box (a cylinder's diameter twice)
  double mass = 0;                ///< kg, apparent at the tip
  double damping = 0;             ///< N s/m
  double encoder_step = 0;        ///< m at the tip
  double probe_force = 40;        ///< N, peak on the probe's hand
  double probe_torque = 2;        ///< N m; 0: the probe's rotations are sensed only
  /// Boxes, frame W, in which the needle's tip and the probe's face are served; a hand outside of
  /// its box feels nothing. Infinite unless a device file says where the device stands.
  Vec3 needle_centre = Vec3::Zero();                                           ///< m
  Vec3 needle_half = Vec3::Constant(std::numeric_limits<double>::infinity());  ///< m
  Vec3 probe_centre = Vec3::Zero();                                            ///< m
  Vec3 probe_half = Vec3::Constant(std::numeric_limits<double>::infinity());   ///< m
};

/// touch, virtuose_6d_desktop, delta, ideal.
[[nodiscard]] std::array<DeviceLimits, 4> device_table();

/// Errors: not_found, with the names there are.
[[nodiscard]] Result<DeviceLimits> find_device(std::string_view name);

/// A device of one's own from a TOML file (docs/haptics.md): `[needle]` and `[probe]` with force_n,
/// torque_nm, workspace_mm and centre_mm; a probe that is not told of has the needle's limits.
/// Errors: unreadable, malformed (syntax, with line), invalid (unknown key, a value out of its
/// range); every problem is named in one message.
[[nodiscard]] Result<DeviceLimits> read_device_file(const std::filesystem::path& file);

/// The same from memory; `name` stands in messages.
[[nodiscard]] Result<DeviceLimits> parse_device_file(std::string_view text,
                                                     const std::string& name);

/// `device`, whose probe's hand is held by `probe`: its force and torque.
[[nodiscard]] DeviceLimits with_probe_device(DeviceLimits device, const DeviceLimits& probe);

/// The wrench scaled into the device's limits, force and torque each keeping its direction.
[[nodiscard]] ARTUS_REALTIME Wrench saturate(const DeviceLimits& device,
                                             const Wrench& wrench) noexcept;

}  // namespace artus
