// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include "artus/detail/core/check.h"
#include "artus/detail/haptics/actuator/pneumatic_params.h"

namespace artus {

/// Voltages of the two valves, V. With one valve only `u_P` counts: its other port feeds chamber N
/// with the opposite opening.
struct ValveCommand {
  double u_P = 5;
  double u_N = 5;
};

/// How many valves feed the cylinder.
enum class ValveLayout { one, two };

/// Mass flow through an orifice from `p_from` to `p_to`, kg/s, negative the other way; sonic below
/// the critical ratio, elliptic above, linear near 1. `share` scales the conductance. `temperature`
/// in K. Source: ISO 6358-1 [ISO6358].
[[nodiscard]] ARTUS_REALTIME double orifice_flow(const ServovalveParams& valve, double share,
                                                 double p_from, double p_to,
                                                 double temperature) noexcept;

/// Mass flow into a chamber at pressure `p` (Pa absolute) through a port whose spool opens it by
/// `opening` in [-1, 1]; strictly rising in `opening`, because near the centre both edges leak.
[[nodiscard]] ARTUS_REALTIME double port_flow(const ServovalveParams& valve, double opening,
                                              double p, double temperature) noexcept;

/// The opening that a voltage asks for, limited to [-1, 1]; NaN closes the valve.
[[nodiscard]] ARTUS_REALTIME double opening_of(const ServovalveParams& valve, double u) noexcept;

/// The voltage of an opening.
[[nodiscard]] ARTUS_REALTIME double voltage_of(const ServovalveParams& valve,
                                               double opening) noexcept;

/// The spool's new opening after `dt` under a constant command; exact for the first-order lag.
[[nodiscard]] ARTUS_REALTIME double step_spool(const ServovalveParams& valve, double opening,
                                               double commanded, double dt) noexcept;

}  // namespace artus
