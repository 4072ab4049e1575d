// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <vector>

#include "artus/evidence/probe/probe_experiment.h"

namespace artus {

/// One of the three compared laws and what the source gave it.
struct PublishedLaw {
  ControlLawKind law;
  const char* label;
  double load_time;           ///< s, when 1 kg is laid on the rod
  double low;                 ///< N/m
  double high;                ///< N/m
  std::vector<double> steps;  ///< N/m; assumed: the figure prints no values
};
[[nodiscard]] std::array<PublishedLaw, 3> published_laws();

/// The times of both published tests, s.
struct PublishedTimes {
  static constexpr double kEnd = 35;
  static constexpr double kPeak = 25;    ///< of the increasing profile
  static constexpr double kPlateau = 5;  ///< of the steps; assumed
};

/// The published statements beside what the traces show: one trace per law in the order of
/// published_laws(), then backstepping without dry friction. Source [Alamilla2020] section 3.3.2.
[[nodiscard]] std::vector<ProbeObservation> observe_isp(const std::vector<ProbeTrace>& traces);
[[nodiscard]] std::vector<ProbeObservation> observe_ssp(const std::vector<ProbeTrace>& traces);

}  // namespace artus
