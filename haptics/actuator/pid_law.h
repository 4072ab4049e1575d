// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include "artus/detail/haptics/actuator/admittance_law.h"

namespace artus {

/// PID and admittance PID: u = 5 V + K_p e + K_i int e + K_d de/dt with e = x_c - y. The integral
/// is limited and stands still while the valve is saturated. Source [Alamilla2020] (3.6)-(3.11).
class PidLaw final : public AdmittanceLaw {
 public:
  PidLaw(const ControlParams& control, const ServovalveParams& valve, bool admittance) noexcept
      : AdmittanceLaw(control, valve, admittance),
        gains_(control.pid),
        derivative_(control.velocity_filter, period()) {}

 private:
  void start(double reference, double y) noexcept override;
  double drive(double reference, double y) noexcept override;

  PidGains gains_;
  LowPass derivative_;
  double integral_ = 0;    // V
  double last_error_ = 0;  // m
};

}  // namespace artus
