// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/haptics/actuator/pneumatic_plant.h"

#include <algorithm>
#include <cmath>

namespace artus {
namespace {

/// The pressure at which what leaks in through the centred valve equals what leaks out.
double find_rest_pressure(const ServovalveParams& valve, double temperature) {
  double low = valve.exhaust;
  double high = valve.supply;
  for (int i = 0; i < 60; ++i) {
    const double middle = (low + high) / 2;
    (port_flow(valve, 0, middle, temperature) > 0 ? low : high) = middle;
  }
  return (low + high) / 2;
}

}  // namespace

PneumaticPlant::PneumaticPlant(const PneumaticParams& params, ValveLayout layout, double substep)
    : cylinder_(params.cylinder), valve_(params.valve), layout_(layout), h_(substep) {
  ARTUS_REQUIRE(substep > 0 && substep <= 1e-4, "the sub-step must be in (0, 1e-4] s");
  state_.p_P = find_rest_pressure(valve_, cylinder_.temperature);
  state_.p_N = state_.p_P;
}

void PneumaticPlant::set_state(const CylinderState& state) noexcept {
  state_ = state;
  energy_ = {};
}

ChamberFlows PneumaticPlant::flows() const noexcept {
  const double opening_N = layout_ == ValveLayout::one ? -spool_P_ : spool_N_;
  return {port_flow(valve_, spool_P_, state_.p_P, cylinder_.temperature),
          port_flow(valve_, opening_N, state_.p_N, cylinder_.temperature)};
}

double PneumaticPlant::kinetic_energy() const noexcept {
  return (cylinder_.moving_mass + load_mass_) * state_.v * state_.v / 2;
}

void PneumaticPlant::step(const ValveCommand& command, const RodLoad& load, double dt) noexcept {
  command_P_ = opening_of(valve_, command.u_P);
  command_N_ = opening_of(valve_, command.u_N);
  energy_.external += (load.mass - load_mass_) * state_.v * state_.v / 2;
  load_mass_ = load.mass;
  const double v_before = state_.v;
  const long n = std::max(1L, std::lround(dt / h_));
  for (long i = 0; i < n; ++i) substep(load);
  const double acceleration = (state_.v - v_before) / (static_cast<double>(n) * h_);
  contact_force_ = load.force + load.mass * (kGravity * std::cos(load.inclination) + acceleration);
}

void PneumaticPlant::substep(const RodLoad& load) noexcept {
  spool_P_ = step_spool(valve_, spool_P_, command_P_, h_);
  spool_N_ = step_spool(valve_, spool_N_, command_N_, h_);
  const double y_before = state_.y;
  move_rod(load);
  move_gas(y_before);
}

void PneumaticPlant::move_rod(const RodLoad& load) noexcept {
  const double mass = cylinder_.moving_mass + load_mass_;
  const double gas = pneumatic_force(cylinder_, state_);
  const double weight = -mass * kGravity * std::cos(load.inclination);
  const double before = state_.v;
  // Viscous friction implicitly, then dry friction as far as it can stop the rod (Coulomb's law in
  // its implicit form), so that sticking is exact.
  const double scale = 1 / (mass / h_ + cylinder_.viscous_friction);
  double after = (mass / h_ * before + gas + weight - load.force) * scale;
  after -= std::clamp(after, -cylinder_.dry_friction * scale, cylinder_.dry_friction * scale);
  const double travelled = h_ * (before + after) / 2;
  energy_.gas += gas * travelled;
  energy_.weight += weight * travelled;
  energy_.external -= load.force * travelled;
  energy_.friction +=
      mass * (after * after - before * before) / 2 - (gas + weight - load.force) * travelled;
  state_.v = after;
  state_.y += h_ * after;
  if (std::abs(state_.y) < cylinder_.travel) return;
  state_.y = std::copysign(cylinder_.travel, state_.y);
  if (state_.v * state_.y > 0) {
    energy_.stops -= kinetic_energy();
    state_.v = 0;
  }
}

void PneumaticPlant::move_gas(double y_before) noexcept {
  const CylinderParams& c = cylinder_;
  const ChamberFlows q = flows();
  const double y = state_.y;
  if (y != y_before) {
    state_.p_P *= std::pow(c.length_p(y_before) / c.length_p(y), c.polytropic);
    state_.p_N *= std::pow(c.length_n(y_before) / c.length_n(y), c.polytropic);
  }
  state_.p_P += h_ * c.krt() * q.q_P / (c.area_P * c.length_p(y));
  state_.p_N += h_ * c.krt() * q.q_N / (c.area_N * c.length_n(y));
}

}  // namespace artus
