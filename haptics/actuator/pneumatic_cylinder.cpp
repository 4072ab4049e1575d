// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/haptics/actuator/pneumatic_cylinder.h"

#include <cmath>

namespace artus {

double pneumatic_force(const CylinderParams& c, const CylinderState& s) noexcept {
  return c.area_P * s.p_P - c.area_N * s.p_N;
}

double pneumatic_stiffness(const CylinderParams& c, const CylinderState& s) noexcept {
  return c.polytropic * (s.p_P * c.area_P / c.length_p(s.y) + s.p_N * c.area_N / c.length_n(s.y));
}

PressureRates pressure_rates(const CylinderParams& c, const CylinderState& s,
                             const ChamberFlows& q) noexcept {
  const double rt = c.gas_constant * c.temperature;
  return {c.polytropic / (c.area_P * c.length_p(s.y)) * (rt * q.q_P - s.p_P * c.area_P * s.v),
          c.polytropic / (c.area_N * c.length_n(s.y)) * (rt * q.q_N + s.p_N * c.area_N * s.v)};
}

ActiveFlows to_active(const CylinderParams& c, double y, const ChamberFlows& q) noexcept {
  const double a = q.q_P / c.length_p(y);
  const double b = q.q_N / c.length_n(y);
  return {c.stroke / 2 * (a - b), c.stroke / 2 * (a + b)};
}

ChamberFlows to_chambers(const CylinderParams& c, double y, const ActiveFlows& q) noexcept {
  return {c.length_p(y) / c.stroke * (q.q_T + q.q_A), c.length_n(y) / c.stroke * (q.q_T - q.q_A)};
}

double force_rate(const CylinderParams& c, const CylinderState& s, const ActiveFlows& q) noexcept {
  return 2 * c.krt() / c.stroke * q.q_A - pneumatic_stiffness(c, s) * s.v;
}

double stiffness_rate(const CylinderParams& c, const CylinderState& s,
                      const ActiveFlows& q) noexcept {
  const double k = c.polytropic;
  const double a_1 = 2 * (k + 1);
  const double a_2 = k * (k + 1);
  const double b_1 = 2 * k * c.krt() / c.stroke;
  const double b_2 = k * c.krt();
  const double sum = a_1 * pneumatic_stiffness(c, s) * s.y * s.v -
                     a_2 * pneumatic_force(c, s) * s.v - b_1 * s.y * q.q_A + b_2 * q.q_T;
  return sum / (c.length_p(s.y) * c.length_n(s.y));
}

double min_pneumatic_stiffness(const CylinderParams& c, double p) noexcept {
  const double root = std::sqrt(c.area_P) + std::sqrt(c.area_N);
  return c.polytropic * p * root * root / c.stroke;
}

double max_pneumatic_stiffness(const CylinderParams& c, double p, double y) noexcept {
  CylinderState s;
  s.y = y;
  s.p_P = p;
  s.p_N = p;
  return pneumatic_stiffness(c, s);
}

}  // namespace artus
