// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include "artus/detail/haptics/actuator/admittance_filter.h"

namespace artus {

/// What the PID and IPC laws share: a reference from the admittance, one voltage about the valve's
/// centre that drives both valves in opposite directions, and its limit.
class AdmittanceLaw : public ControlLaw {
 public:
  ARTUS_REALTIME void reset(const ControlInput& input) noexcept final;
  ARTUS_REALTIME ControlOutput step(const ControlInput& input) noexcept final;

 protected:
  /// `active`: whether the force moves the reference.
  AdmittanceLaw(const ControlParams& control, const ServovalveParams& valve, bool active) noexcept
      : dt_(1 / control.rate),
        centre_(valve.centre_voltage),
        span_(valve.voltage_span),
        admittance_(active, control.force_filter, dt_) {}

  /// Forgets the past: the rod is at `y`, the reference at `reference`, m.
  virtual void start(double reference, double y) noexcept = 0;
  /// The wanted voltage about the centre, V; what is beyond span() is cut off.
  virtual double drive(double reference, double y) noexcept = 0;

  [[nodiscard]] double period() const noexcept { return dt_; }  ///< s
  [[nodiscard]] double span() const noexcept { return span_; }  ///< V

 private:
  double dt_;
  double centre_;
  double span_;
  Admittance admittance_;
};

}  // namespace artus
