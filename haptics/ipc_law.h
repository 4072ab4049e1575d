// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include "haptics/admittance_filter.h"

namespace artus {

/// Intrinsically passive control, plain and with admittance: a virtual mass between two springs,
/// one to the reference, one to the rod; the valve opens by the second one's force. Integrated
/// semi-implicitly. Source [Alamilla2020] (3.12), the voltage taken about the valve's centre.
class IpcLaw final : public ControlLaw {
 public:
  IpcLaw(const ControlParams& control, const ServovalveParams& valve, bool admittance) noexcept;
  ARTUS_REALTIME void reset(const ControlInput& input) noexcept override;
  ARTUS_REALTIME ControlOutput step(const ControlInput& input) noexcept override;

 private:
  IpcGains gains_;
  double dt_;
  double centre_;
  double span_;
  Admittance admittance_;
  double x_ = 0;  // m, of the virtual mass
  double v_ = 0;  // m/s
};

}  // namespace artus
