// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include "artus/detail/evidence/validation/probe/probe_experiment.h"

/// The probe experiments themselves; gates.h runs them by name.
namespace artus {

/// Increasing stiffness under 1 kg. Source [Alamilla2020] section 3.3.2, figs. 3-16 to 3-19.
[[nodiscard]] ProbeExperiment run_probe_isp(const ProbeExperimentOptions& options);
/// Stiffness steps under 1 kg. Source [Alamilla2020] section 3.3.2, figs. 3-20 to 3-24.
[[nodiscard]] ProbeExperiment run_probe_ssp(const ProbeExperimentOptions& options);
/// Every law that renders a stiffness under every disturbance: which renders tissue best?
[[nodiscard]] ProbeExperiment run_probe_study(const ProbeExperimentOptions& options);

}  // namespace artus
