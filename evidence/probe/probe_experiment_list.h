// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include "artus/evidence/probe/probe_experiment.h"

/// The probe experiments themselves; probe_experiment.h runs them by name.
namespace artus {

/// Increasing stiffness under 1 kg. Source [Alamilla2020] section 3.3.2, figs. 3-16 to 3-19.
[[nodiscard]] ProbeExperiment run_probe_isp(const ProbeExperimentOptions& options);
/// Stiffness steps under 1 kg. Source [Alamilla2020] section 3.3.2, figs. 3-20 to 3-24.
[[nodiscard]] ProbeExperiment run_probe_ssp(const ProbeExperimentOptions& options);
/// Every law that renders a stiffness under every disturbance: which renders tissue best?
[[nodiscard]] ProbeExperiment run_probe_study(const ProbeExperimentOptions& options);

/// A curve of a trace over time.
template <class F>
[[nodiscard]] PlotSeries plot_probe_rows(const std::vector<ProbeRow>& rows, std::string label,
                                         F value) {
  PlotSeries series;
  series.label = std::move(label);
  for (const ProbeRow& row : rows) {
    series.x.push_back(row.time);
    series.y.push_back(value(row));
  }
  return series;
}

/// A number with so many digits after the point, for tables.
[[nodiscard]] std::string fixed(double value, int digits);

}  // namespace artus
