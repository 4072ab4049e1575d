// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include "haptics/admittance_filter.h"

namespace artus {

/// PID and admittance PID: u = 5 V + K_p e + K_i int e + K_d de/dt with e = x_c - y. The integral
/// is limited and stands still while the valve is saturated. Source [Alamilla2020] (3.6)-(3.11).
class PidLaw final : public ControlLaw {
 public:
  PidLaw(const ControlParams& control, const ServovalveParams& valve, bool admittance) noexcept;
  ARTUS_REALTIME void reset(const ControlInput& input) noexcept override;
  ARTUS_REALTIME ControlOutput step(const ControlInput& input) noexcept override;

 private:
  PidGains gains_;
  double dt_;
  double centre_;
  double span_;
  Admittance admittance_;
  LowPass derivative_;
  double integral_ = 0;    // V
  double last_error_ = 0;  // m
};

}  // namespace artus
