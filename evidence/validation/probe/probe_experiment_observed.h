// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <string>
#include <vector>

#include "artus/detail/evidence/validation/probe/probe_experiment.h"

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
/// published_laws(); more are not looked at. Source [Alamilla2020] section 3.3.2.
[[nodiscard]] std::vector<ProbeObservation> observe_isp(const std::vector<ProbeTrace>& traces);
[[nodiscard]] std::vector<ProbeObservation> observe_ssp(const std::vector<ProbeTrace>& traces);

/// The same observations with another value of something.
struct ProbeRerun {
  std::string what;
  std::vector<ProbeObservation> observations;
};

/// Sets the cause of each refuted observation: with which other values it is reproduced.
void find_causes(const std::vector<ProbeRerun>& reruns, std::vector<ProbeObservation>& base);

/// Each as a claim that holds when it is reproduced.
[[nodiscard]] std::vector<Claim> claim_observations(
    const std::vector<ProbeObservation>& observations);

}  // namespace artus
