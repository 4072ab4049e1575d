// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/haptics/actuator/backstepping_law.h"

#include <algorithm>
#include <cmath>

#include "artus/detail/haptics/actuator/servovalve.h"

namespace artus {
namespace {

/// How far above critical the default damping is; assumed: keeps (3.41) true under rounding.
constexpr double kDampingMargin = 1.05;
/// Chamber pressures the wanted K_pneu may ask for, as shares of exhaust and supply; assumed:
/// leaves the valves a pressure drop to work with.
constexpr double kMinPressure = 1.2;
constexpr double kMaxPressure = 0.9;
/// Wanted speeds below this count as rest for the dry friction, m/s; assumed.
constexpr double kRestSpeed = 1e-4;

}  // namespace

double min_closed_loop_damping(double mass, double stiffness) noexcept {
  return stiffness > mass ? 2 * std::sqrt(mass * (stiffness - mass)) : 0;
}

std::optional<StiffnessGains> find_stiffness_gains(double mass, double stiffness,
                                                   double damping) noexcept {
  if (!(stiffness > mass) || !(damping >= min_closed_loop_damping(mass, stiffness))) return {};
  const double square = damping * damping - 4 * mass * (stiffness - mass);
  const double root = std::sqrt(std::max(0.0, square));
  if (!std::isfinite(root)) return {};
  return StiffnessGains{(damping + root) / (2 * mass), (damping - root) / (2 * mass)};
}

double closed_loop_stiffness(double mass, double c_1, double c_2) noexcept {
  return mass * (c_1 * c_2 + 1);
}

BacksteppingLaw::BacksteppingLaw(const ControlParams& control, const PneumaticParams& plant,
                                 const ValveMap& map, bool two_valves) noexcept
    : gains_(control.backstepping),
      cylinder_(plant.cylinder),
      valve_(plant.valve),
      map_(&map),
      two_valves_(two_valves),
      dt_(1 / control.rate) {}

void BacksteppingLaw::reset(const ControlInput& input) noexcept {
  z_ = {};
  take_gains(input.target);
}

bool BacksteppingLaw::take_gains(const ProbeTarget& target) noexcept {
  if (!gains_.from_target) return true;
  if (target.stiffness < kMinFeltStiffness) return false;
  const double mass = cylinder_.moving_mass;
  const double damping = target.damping > 0
                             ? target.damping
                             : kDampingMargin * min_closed_loop_damping(mass, target.stiffness);
  const auto found = find_stiffness_gains(mass, target.stiffness, damping);
  if (!found) return false;
  gains_.c_1 = found->c_1;
  gains_.c_2 = found->c_2;
  return true;
}

double BacksteppingLaw::dry_friction(double v_d) const noexcept {
  if (std::abs(v_d) < kRestSpeed) return 0;
  return std::copysign(cylinder_.dry_friction, v_d);
}

double BacksteppingLaw::active_flow(const CylinderState& s, const ProbeTarget& target) noexcept {
  const double mass = cylinder_.moving_mass;
  const double c_1 = gains_.c_1;
  const double c_2 = gains_.c_2;
  const double force = pneumatic_force(cylinder_, s);
  const double resistance = cylinder_.viscous_friction * s.v + dry_friction(target.v) +
                            mass * kGravity * std::cos(target.inclination) + target.known_force;
  z_.z_1 = s.y - target.y;
  z_.z_2 = s.v - (target.v - c_1 * z_.z_1);
  const double wanted =
      resistance + mass * (target.a + z_.z_1 * (c_1 * c_1 - 1) - z_.z_2 * (c_1 + c_2));
  z_.z_3 = force - wanted;

  // (3.32) times 2 k r T / l, which makes every term a rate of force.
  const double f_0 = cylinder_.viscous_friction * (force - resistance) / mass +
                     pneumatic_stiffness(cylinder_, s) * s.v + mass * target.j;
  const double f_1 = mass * (-c_1 * c_1 * c_1 + 2 * c_1 + c_2);
  const double f_2 = mass * (c_1 * c_1 + c_1 * c_2 + c_2 * c_2 - 1) - 1 / mass;
  const double f_3 = -(c_1 + c_2 + gains_.c_3);
  const double rate = f_0 + f_1 * z_.z_1 + f_2 * z_.z_2 + f_3 * z_.z_3 - gains_.k_3i * z_.z_3i;
  return rate * cylinder_.stroke / (2 * cylinder_.krt());
}

double BacksteppingLaw::feasible_stiffness(const CylinderState& s, double wanted) const noexcept {
  const CylinderParams& c = cylinder_;
  const double force = pneumatic_force(c, s);
  const double min = kMinPressure * valve_.exhaust;
  const double max = kMaxPressure * valve_.supply;
  // At a given force one chamber pressure sets the other, and K_pneu rises with both.
  const auto stiffness = [&](double p_N) {
    const double push_N = p_N * c.area_N;
    return c.polytropic * ((force + push_N) / c.length_p(s.y) + push_N / c.length_n(s.y));
  };
  const double low = stiffness(std::max(min, (min * c.area_P - force) / c.area_N));
  const double high = stiffness(std::min(max, (max * c.area_P - force) / c.area_N));
  return std::max(low, std::min(high, wanted));
}

double BacksteppingLaw::pressurisation_flow(const CylinderState& s, const ProbeTarget& target,
                                            double q_A) const noexcept {
  const CylinderParams& c = cylinder_;
  const double k = c.polytropic;
  const double stiffness = pneumatic_stiffness(c, s);
  const double z_4 = stiffness - feasible_stiffness(s, target.pneumatic);
  const double wanted =
      c.length_p(s.y) * c.length_n(s.y) * (target.pneumatic_rate - gains_.c_4 * z_4);
  const double moving =
      k * (k + 1) * s.v * pneumatic_force(c, s) - 2 * (k + 1) * s.v * s.y * stiffness;
  return (wanted + moving) / (k * c.krt()) + 2 * s.y * q_A / c.stroke;
}

ControlOutput BacksteppingLaw::step(const ControlInput& input) noexcept {
  ControlOutput out;
  out.target_refused = !take_gains(input.target);
  CylinderState s;
  s.y = std::clamp(input.measured.y, -cylinder_.travel, cylinder_.travel);
  s.v = input.v;
  s.p_P = input.measured.p_P;
  s.p_N = input.measured.p_N;
  const double q_A = active_flow(s, input.target);
  bool saturated = false;
  if (two_valves_) {
    const ActiveFlows flows{q_A, pressurisation_flow(s, input.target, q_A)};
    const ChamberFlows q = to_chambers(cylinder_, s.y, flows);
    const double x_P = map_->find_opening(q.q_P, s.p_P);
    const double x_N = map_->find_opening(q.q_N, s.p_N);
    saturated = std::max(std::abs(x_P), std::abs(x_N)) >= 1;
    out.command = {voltage_of(valve_, x_P), voltage_of(valve_, x_N)};
  } else {
    const double x = map_->find_active_opening(q_A, s.p_P, s.p_N, s.y);
    saturated = std::abs(x) >= 1;
    out.command = {voltage_of(valve_, x), voltage_of(valve_, -x)};
  }
  if (!saturated) {
    z_.z_3i = std::clamp(z_.z_3i + dt_ * z_.z_3, -gains_.z_3i_limit, gains_.z_3i_limit);
  }
  out.reference = input.target.y;
  return out;
}

}  // namespace artus
