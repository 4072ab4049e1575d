// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <filesystem>
#include <optional>
#include <string>

#include "artus/detail/apps/options/command.h"
#include "artus/haptics/device.h"

namespace artus {

/// --haptic-rate, or the names that a command has for it: messages tell the first.
void add_haptic_rate_option(Command* command, double& rate_hz,
                            const std::string& names = "--haptic-rate");
/// --needle-length-mm, hub to tip, for the forces and for the picture.
void add_needle_length_option(Command* command, std::optional<double>& length_mm);
/// --device, by its name in the catalogue of devices.
void add_device_option(Command* command, std::string& device);

/// Devices that a catalogue does not have, and the probe's own.
struct OwnDeviceOptions {
  std::filesystem::path file;  ///< --device-file; empty: the catalogue's
  std::string probe_device;    ///< --probe-device; empty: a second one of the needle's kind
};
void add_own_device_options(Command* command, OwnDeviceOptions& options);
/// The limits that the flags mean. Errors: not_found (a name), those of read_device_file.
[[nodiscard]] Result<DeviceLimits> chosen_device(const std::string& device,
                                                 const OwnDeviceOptions& own);

}  // namespace artus
