// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include "options.h"

namespace artus::bridge {

/// Holds a device at rest for 2 s, says its rate, where it is, its axes in W and its buttons, then
/// pushes with 0.3 N along each axis both ways, half a second each, and says where it went. A hand
/// holds the device loosely. Without artus. 0: the device was there to the end; else 1.
int run_check(Driver& driver, const Options& options);

}  // namespace artus::bridge
