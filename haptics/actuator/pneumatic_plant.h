// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include "artus/detail/core/check.h"
#include "artus/detail/haptics/actuator/pneumatic_cylinder.h"
#include "artus/detail/haptics/actuator/servovalve.h"

namespace artus {

/// What the hand or a weight does to the rod.
struct RodLoad {
  double force = 0;        ///< N, F_ext: positive pushes the rod in (towards -y)
  double mass = 0;         ///< kg resting on the rod: adds weight and inertia
  double inclination = 0;  ///< rad, theta between the rod and the vertical
};

/// Where the rod's energy went since the start, J. Kinetic energy = the sum of all.
struct RodEnergy {
  double gas = 0;       ///< work of the pneumatic force
  double external = 0;  ///< work of the load's force, and kinetic energy of mass laid on
  double weight = 0;    ///< work of gravity on rod and load
  double friction = 0;  ///< work of dry and viscous friction, <= 0
  double stops = 0;     ///< lost at the end stops, <= 0
};

/// The pneumatic probe mock: rod, chambers, valves. Integrated with a fixed sub-step: the spool's
/// lag and the polytropic compression exactly, friction implicitly (a rod that sticks stays exactly
/// still, and friction only ever takes energy), the rest semi-implicitly. Deterministic.
class PneumaticPlant {
 public:
  /// Starts at rest at y = 0 with the pressures at which the centred valve's leaks balance.
  /// Requires: substep in (0, 1e-4] s (std::invalid_argument).
  PneumaticPlant(const PneumaticParams& params, ValveLayout layout, double substep = 2e-5);

  /// Advances by `dt`, a whole number of sub-steps (the nearest; at least one).
  ARTUS_REALTIME void step(const ValveCommand& command, const RodLoad& load, double dt) noexcept;

  /// Puts the rod and the chambers into a state; the energy account starts anew.
  void set_state(const CylinderState& state) noexcept;

  /// Changes the supply, Pa absolute. Requires: > 0.
  void set_supply(double pressure) noexcept { valve_.supply = pressure; }
  [[nodiscard]] double supply() const noexcept { return valve_.supply; }

  [[nodiscard]] const CylinderState& state() const noexcept { return state_; }
  [[nodiscard]] const CylinderParams& cylinder() const noexcept { return cylinder_; }
  [[nodiscard]] ChamberFlows flows() const noexcept;  ///< at this instant, kg/s
  [[nodiscard]] double spool_p() const noexcept { return spool_P_; }
  [[nodiscard]] const RodEnergy& energy() const noexcept { return energy_; }
  [[nodiscard]] double kinetic_energy() const noexcept;  ///< J, of rod and load
  /// Between the load and the rod, N, averaged over the last step: what the force sensor feels.
  [[nodiscard]] double contact_force() const noexcept { return contact_force_; }

 private:
  void substep(const RodLoad& load) noexcept;
  void move_rod(const RodLoad& load) noexcept;
  void move_gas(double y_before) noexcept;

  CylinderParams cylinder_;
  ServovalveParams valve_;
  ValveLayout layout_;
  double h_;  // s
  CylinderState state_;
  double spool_P_ = 0;
  double spool_N_ = 0;
  double command_P_ = 0;
  double command_N_ = 0;
  double load_mass_ = 0;
  double contact_force_ = 0;
  RodEnergy energy_;
};

}  // namespace artus
