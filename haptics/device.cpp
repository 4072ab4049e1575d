// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/haptics/device.h"

#include <array>
#include <string>
#include <vector>

#include "artus/detail/core/known_names.h"

namespace artus {
namespace {

Vec3 limit_norm(const Vec3& v, double limit) noexcept {
  const double norm = v.norm();
  return norm > limit ? Vec3(v * (limit / norm)) : v;
}

/// Devices that bridges drive and no published experiment used: makers' forces and workspaces of
/// omega and falcon, assumed of inverse3; mass, damping and step assumed of all.
std::array<DeviceLimits, 3> bridged_devices() {
  return {{
      {"omega", 12.0, 0.0, Vec3(0.16, 0.16, 0.11), 0.20, 1.0, 10e-6, 12.0, 0.0},
      {"falcon", 8.0, 0.0, Vec3(0.10, 0.10, 0.10), 0.20, 1.0, 60e-6, 8.0, 0.0},
      {"inverse3", 8.0, 0.0, Vec3(0.30, 0.20, 0.20), 0.15, 1.0, 20e-6, 8.0, 0.0},
  }};
}

}  // namespace

std::array<DeviceLimits, 4> device_table() {
  return {{
      {"touch", 3.0, 0.0, Vec3(0.16, 0.12, 0.07), 0.045, 0.3, 55e-6, 3.0, 0.0},
      {"virtuose_6d_desktop", 10.0, 0.8, Vec3(0.52, 0.37, 0.40), 0.30, 2.0, 10e-6, 10.0, 0.8},
      {"delta", 12.0, 0.0, Vec3(0.16, 0.16, 0.11), 0.20, 1.0, 30e-6, 12.0, 0.0},
      {"ideal", 50.0, 5.0, Vec3(2, 2, 2), 0.10, 2.0, 1e-6, 40.0, 2.0},
  }};
}

Result<DeviceLimits> find_device(std::string_view name) {
  std::vector<DeviceLimits> devices;
  for (const DeviceLimits& device : device_table()) devices.push_back(device);
  for (const DeviceLimits& device : bridged_devices()) devices.push_back(device);
  const auto at = find_name(item_names(devices), name, "device");
  ARTUS_TRY(at);
  return devices.at(*at);
}

DeviceLimits with_probe_device(DeviceLimits device, const DeviceLimits& probe) {
  device.probe_force = probe.force;
  device.probe_torque = probe.torque;
  return device;
}

Wrench saturate(const DeviceLimits& device, const Wrench& wrench) noexcept {
  return {limit_norm(wrench.force, device.force), limit_norm(wrench.torque, device.torque)};
}

}  // namespace artus
