// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/apps/options/device_options.h"

#include <utility>

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
                   "haptic device, for its force limits: touch, virtuose_6d_desktop, delta, omega, "
                   "falcon, inverse3, ideal")
      ->capture_default_str();
}

void add_own_device_options(Command* command, OwnDeviceOptions& options) {
  command->add_option("--device-file", options.file,
                      "limits of your own device, needle's and probe's, in place of --device "
                      "(docs/haptics.md)");
  command->add_option("--probe-device", options.probe_device,
                      "whose force limits hold for the probe's hand, by name (default: as the "
                      "needle's)");
}

Result<DeviceLimits> chosen_device(const std::string& device, const OwnDeviceOptions& own) {
  auto limits = own.file.empty() ? find_device(device) : read_device_file(own.file);
  ARTUS_TRY(limits);
  if (own.probe_device.empty()) return limits;
  const auto probe = find_device(own.probe_device);
  ARTUS_TRY(probe);
  return with_probe_device(std::move(*limits), *probe);
}

}  // namespace artus
