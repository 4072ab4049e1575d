// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <optional>
#include <string>

#include "artus/detail/apps/options/command.h"

namespace artus {

/// --haptic-rate, or the names that a command has for it: messages tell the first.
void add_haptic_rate_option(Command* command, double& rate_hz,
                            const std::string& names = "--haptic-rate");
/// --needle-length-mm, hub to tip, for the forces and for the picture.
void add_needle_length_option(Command* command, std::optional<double>& length_mm);
/// --device, by its name in the catalogue of devices.
void add_device_option(Command* command, std::string& device);

}  // namespace artus
