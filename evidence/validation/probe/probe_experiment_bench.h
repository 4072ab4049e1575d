// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "artus/detail/haptics/actuator/control_law_supervisor.h"
#include "artus/detail/haptics/actuator/pneumatic_plant.h"

namespace artus {

/// One instant of a run of the probe mock.
struct ProbeRow {
  double time = 0;           ///< s
  double stiffness = 0;      ///< N/m, wanted
  double rest = 0;           ///< m, x_0
  double expected = 0;       ///< m, x_c = x_0 - F/K with the true force
  double y = 0;              ///< m, true rod position
  double v = 0;              ///< m/s
  double force = 0;          ///< N, true, on the rod's head
  double u_P = 0;            ///< V
  double u_N = 0;            ///< V
  double p_P = 0;            ///< Pa absolute
  double p_N = 0;            ///< Pa absolute
  double pneumatic = 0;      ///< N/m, K_pneu
  std::uint32_t status = 0;  ///< ControlStatus bits
  double energy_error = 0;   ///< J, kinetic energy of rod and load less all work done on them
  [[nodiscard]] double error() const noexcept { return expected - y; }
};

/// What happens in a run. Functions that are empty do nothing.
struct ProbeScenario {
  ControlLawKind law = ControlLawKind::backstepping_one_valve;
  double duration = 10;                            ///< s
  std::function<ProbeTarget(double time)> target;  ///< required
  /// The stiffness to render, N/m, from the measured rod position; empty: the target's own.
  std::function<double(double y)> stiffness;
  /// The load on the rod, from the time and the true state of the rod.
  std::function<RodLoad(double time, const CylinderState&)> load;
  /// Breaks things: called before each control tick.
  std::function<void(double time, PneumaticPlant&, ProbeSensors&)> disturb;
  double noise = 1;  ///< times the sensors' own
  std::uint64_t seed = 1;
  PneumaticParams plant;
  ControlParams control;
};

/// The simulated mock under supervised control, from rest at x_0 = 0. A row every 2 ms.
/// Deterministic. Requires: a target.
[[nodiscard]] std::vector<ProbeRow> run_probe_scenario(const ProbeScenario& scenario);

/// Stiffness over time that rises evenly from `low` to `high` between two times.
[[nodiscard]] std::function<ProbeTarget(double)> ramp_stiffness(double low, double high,
                                                                double start, double end);

/// Stiffness that takes the values one after the other, each for `plateau` s from `start` on; the
/// first before, the last after.
[[nodiscard]] std::function<ProbeTarget(double)> step_stiffness(std::vector<double> values,
                                                                double start, double plateau);

/// A weight that a hand lays on the rod: the hand lets go of it evenly over 0.3 s (assumed).
[[nodiscard]] std::function<RodLoad(double, const CylinderState&)> lay_mass(double mass,
                                                                            double time);

/// Metrics over the rows with from <= time < to.
struct ProbeWindow {
  double largest_error = 0;     ///< m
  double mean_error = 0;        ///< m, of the magnitude
  double lowest_voltage = 0;    ///< V
  double highest_voltage = 0;   ///< V
  double voltage_travel = 0;    ///< V/s, total variation of u_P per second, sampled every 2 ms
  double lowest_pneumatic = 0;  ///< N/m
  double highest_pneumatic = 0;
  double lowest_pressure = 0;  ///< Pa, of either chamber
  double highest_pressure = 0;
  double energy_error = 0;  ///< J, largest magnitude
};
[[nodiscard]] ProbeWindow measure_window(const std::vector<ProbeRow>& rows, double from, double to);

/// The rows as CSV text.
[[nodiscard]] std::string probe_csv(const std::vector<ProbeRow>& rows);

}  // namespace artus
