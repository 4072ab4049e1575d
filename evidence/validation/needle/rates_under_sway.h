// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include "artus/detail/evidence/validation/needle/experiment.h"

namespace artus {

/// A part of the experiment `rates`: a hand that sways by 1 mm at 4 Hz pushes a needle in, draws it
/// back to several depths and pushes it in again, on each device at 1, 2 and 10 kHz. Adds rows to
/// the first table and claims of the total force and of the force aside.
void compare_rates_under_sway(const ExperimentOptions& options, Experiment& out);

}  // namespace artus
