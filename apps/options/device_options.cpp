// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/apps/options/device_options.h"

namespace artus {

void add_haptic_rate_option(Command* command, double& rate_hz, const std::string& names) {
  command->add_option(names, rate_hz, "ticks a second, Hz")
      ->check(number_in(100, 20000))
      ->capture_default_str();
}

void add_needle_length_option(Command* command, std::optional<double>& length_mm) {
  command->add_option("--needle-length-mm", length_mm, "hub to tip (default: 35)")
      ->check(number_in(10, 300));
}

void add_device_option(Command* command, std::string& device) {
  command
      ->add_option("--device", device,
                   "whose force limits hold: touch, virtuose_6d_desktop, delta, ideal")
      ->capture_default_str();
}

}  // namespace artus
