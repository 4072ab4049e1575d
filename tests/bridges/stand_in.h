// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <atomic>
#include <cstdint>
#include <cstdlib>

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

namespace artus::test {

/// What two stand-in devices are and feel, in a file that the test and the stand-in of a maker's
/// library both map: the device outlives the program that drives it.
struct StandInDevice {
  std::atomic<int> plugged;
  std::atomic<int> error;  ///< that each call gives
  std::atomic<std::uint32_t> buttons;
  std::atomic<double> position[3];  ///< m
  std::atomic<double> rotation[9];  ///< of the tool, row after row; all zero: the identity
  std::atomic<double> force[3];     ///< N, as last sent
  std::atomic<std::uint64_t> sends;
  std::atomic<int> opened;
};
inline double rotation_of(const StandInDevice& device, int row, int column) {
  double sum = 0;
  for (const auto& value : device.rotation) sum += value * value;
  if (sum == 0) return row == column ? 1 : 0;
  return device.rotation[3 * row + column];
}
struct StandIn {
  StandInDevice devices[2];
};

/// The file that ARTUS_STAND_IN names, or `path`.
inline StandIn* map_stand_in(const char* path = nullptr) {
  const int file =
      open(path != nullptr ? path : std::getenv("ARTUS_STAND_IN"), O_RDWR | O_CREAT, 0600);
  if (file < 0 || ftruncate(file, sizeof(StandIn)) != 0) return nullptr;
  void* at = mmap(nullptr, sizeof(StandIn), PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
  close(file);
  return at == MAP_FAILED ? nullptr : static_cast<StandIn*>(at);
}

}  // namespace artus::test
