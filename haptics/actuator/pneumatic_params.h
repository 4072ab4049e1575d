// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <filesystem>
#include <string>
#include <string_view>

#include "artus/core/result.h"

namespace artus {

/// Standard gravity, m/s^2.
inline constexpr double kGravity = 9.80665;
/// Density of air at the reference atmosphere of ISO 8778 that sonic conductance refers to, kg/m^3.
inline constexpr double kReferenceDensity = 1.185;
/// Temperature of that atmosphere, K.
inline constexpr double kReferenceTemperature = 293.15;

/// The cylinder and its rod. Values of [Alamilla2020] table 3.3; areas in mm^2, see
/// docs/probe.md.
struct CylinderParams {
  double moving_mass = 0.37;       ///< kg, M
  double area_P = 78.540e-6;       ///< m^2, S_P
  double area_N = 65.974e-6;       ///< m^2, S_N
  double dry_friction = 5.2;       ///< N, static and sliding level alike
  double viscous_friction = 67.9;  ///< N s/m, b
  double stroke = 0.05;            ///< m, l
  double travel = 0.0222;          ///< m, end stops at +-travel; what makes (3.43) give 14155 N/m
  double polytropic = 1.2;         ///< k
  double gas_constant = 287;       ///< J/(kg K), r
  double temperature = 298;        ///< K, T

  [[nodiscard]] double length_p(double y) const noexcept { return stroke / 2 + y; }
  [[nodiscard]] double length_n(double y) const noexcept { return stroke / 2 - y; }
  /// k r T, J/kg.
  [[nodiscard]] double krt() const noexcept { return polytropic * gas_constant * temperature; }
};

/// A proportional 5/3-way valve by ISO 6358. Its opening is -1 (fully to exhaust) .. 1 (fully to
/// supply), proportional to voltage about the centre.
struct ServovalveParams {
  double sonic_conductance = 3.9e-9;  ///< m^3/(s Pa), fully open
  double critical_ratio = 0.3;        ///< b of ISO 6358
  double laminar_ratio = 0.995;  ///< above it the flow is linear in the pressure drop; assumed:
                                 ///< usual numerical choice
  double centre_opening = 0.01;  ///< of each edge at the centre (leakage); assumed
  double spool_frequency = 100;  ///< Hz, first-order lag
  double centre_voltage = 5;     ///< V
  double voltage_span = 5;       ///< V from the centre to fully open
  double supply = 4e5;           ///< Pa absolute
  double exhaust = 1e5;          ///< Pa absolute
};

/// One sensor: what it adds and how finely it resolves.
struct SensorParams {
  double noise = 0;  ///< standard deviation, in the sensor's unit
  double step = 0;   ///< quantisation, in the sensor's unit; 0: none
  double low = 0;    ///< smallest value a working sensor can report
  double high = 0;   ///< largest
};

/// The sensors of the mock. Resolutions: 16 bits over the range; noise: assumed.
struct ProbeSensorParams {
  SensorParams pressure{200, 15.3, 0, 1e6};               ///< Pa absolute, each chamber
  SensorParams position{1.5e-6, 0.76e-6, -0.025, 0.025};  ///< m
  SensorParams force{0.01, 1.5e-3, -50, 50};              ///< N, towards the shell positive
};

/// Everything about the hardware that is simulated.
struct PneumaticParams {
  CylinderParams cylinder;
  ServovalveParams valve;
  ProbeSensorParams sensors;
};

/// Reads the parameters of a probe mock; an absent key keeps its default. Errors: unreadable,
/// malformed (syntax, with line), invalid (unknown key, value out of its physical range); every
/// problem is named in one message.
[[nodiscard]] Result<PneumaticParams> read_pneumatic_params(const std::filesystem::path& file);

/// The same from memory; `name` stands in messages.
[[nodiscard]] Result<PneumaticParams> parse_pneumatic_params(std::string_view text,
                                                             const std::string& name);

/// The mock that comes with artus (devices/pneumatic_probe.toml, built in).
[[nodiscard]] Result<PneumaticParams> read_bundled_pneumatic_params();

}  // namespace artus
