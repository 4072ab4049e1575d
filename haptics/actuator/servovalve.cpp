// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/haptics/actuator/servovalve.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace artus {
namespace {

/// The flow function of ISO 6358 over the pressure ratio, 0..1.
double flow_function(const ServovalveParams& valve, double ratio) noexcept {
  const auto elliptic = [&](double r) {
    const double s = (r - valve.critical_ratio) / (1 - valve.critical_ratio);
    return std::sqrt(1 - s * s);
  };
  if (ratio <= valve.critical_ratio) return 1;
  if (ratio < valve.laminar_ratio) return elliptic(ratio);
  return elliptic(valve.laminar_ratio) * (1 - ratio) / (1 - valve.laminar_ratio);
}

/// How far an edge is open: `opening` where it is large, `centre_opening` at the centre, never
/// quite closed.
double edge(const ServovalveParams& valve, double opening) noexcept {
  const double leak = 2 * valve.centre_opening;
  return (opening + std::sqrt(opening * opening + leak * leak)) / 2;
}

}  // namespace

double orifice_flow(const ServovalveParams& valve, double share, double p_from, double p_to,
                    double temperature) noexcept {
  const double up = std::max(p_from, p_to);
  if (up <= 0) return 0;
  const double down = std::min(p_from, p_to);
  const double q = share * valve.sonic_conductance * kReferenceDensity * up *
                   std::sqrt(kReferenceTemperature / temperature) * flow_function(valve, down / up);
  return p_from >= p_to ? q : -q;
}

double port_flow(const ServovalveParams& valve, double opening, double p,
                 double temperature) noexcept {
  return orifice_flow(valve, edge(valve, opening), valve.supply, p, temperature) -
         orifice_flow(valve, edge(valve, -opening), p, valve.exhaust, temperature);
}

double opening_of(const ServovalveParams& valve, double u) noexcept {
  if (!std::isfinite(u)) return 0;
  return std::clamp((u - valve.centre_voltage) / valve.voltage_span, -1.0, 1.0);
}

double voltage_of(const ServovalveParams& valve, double opening) noexcept {
  return valve.centre_voltage + opening * valve.voltage_span;
}

double step_spool(const ServovalveParams& valve, double opening, double commanded,
                  double dt) noexcept {
  const double rate = 2 * std::numbers::pi * valve.spool_frequency;
  return commanded + (opening - commanded) * std::exp(-rate * dt);
}

}  // namespace artus
