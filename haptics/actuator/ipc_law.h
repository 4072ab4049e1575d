// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include "artus/detail/haptics/actuator/admittance_law.h"

namespace artus {

/// Intrinsically passive control, plain and with admittance: a virtual mass between two springs,
/// one to the reference, one to the rod; the valve opens by the second one's force. Integrated
/// semi-implicitly. Source [Alamilla2020] (3.12), the voltage taken about the valve's centre.
class IpcLaw final : public AdmittanceLaw {
 public:
  IpcLaw(const ControlParams& control, const ServovalveParams& valve, bool admittance) noexcept
      : AdmittanceLaw(control, valve, admittance), gains_(control.ipc) {}

 private:
  void start(double reference, double y) noexcept override;
  double drive(double reference, double y) noexcept override;

  IpcGains gains_;
  double x_ = 0;  // m, of the virtual mass
  double v_ = 0;  // m/s
};

}  // namespace artus
