// SPDX-License-Identifier: AGPL-3.0-or-later
// Moves a stand-in device into the simple shoulder and out again for so many seconds, as a hand
// would, and says what it felt: the largest force and how many forces were sent.
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include <time.h>

#include "tests/bridges/stand_in.h"

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  artus::test::StandIn* memory = artus::test::map_stand_in(argv[1]);
  if (memory == nullptr) return 1;
  artus::test::StandInDevice& device = memory->devices[0];
  device.plugged = 1;
  const double seconds = std::atof(argv[2]);
  const double entry[3] = {-0.0518, 0, -0.0139};  // m in W, of the example device
  const double way[3] = {0.7233, 0, 0.6906};
  // Columns of the needle's frame in W, z along the way; then of the tool, which points the other
  // way, in a device with x right, y up, z to the user.
  const double needle[9] = {way[2], 0, way[0], 0, 1, 0, -way[0], 0, way[2]};
  for (int j = 0; j < 3; ++j) {
    const double sign = j == 0 ? 1 : -1;
    device.rotation[j] = sign * needle[j];
    device.rotation[3 + j] = sign * needle[6 + j];
    device.rotation[6 + j] = -sign * needle[3 + j];
  }
  double most = 0;
  const std::uint64_t begin = device.sends;
  for (double t = 0; t < seconds; t += 1e-3) {
    const double depth = 0.006 * (1 - std::cos(0.4 * t)) - 0.006;  // m, slower than 3 mm/s
    double p[3];
    for (int i = 0; i < 3; ++i) p[i] = entry[i] + depth * way[i];
    device.position[0] = p[0];  // W of a device with x right, y up, z to the user
    device.position[1] = p[2];
    device.position[2] = -p[1];
    device.buttons = t < 1 ? 4 : 0;
    double sum = 0;
    for (const auto& force : device.force) sum += force * force;
    most = std::fmax(most, std::sqrt(sum));
    const timespec millisecond{0, 1'000'000};
    nanosleep(&millisecond, nullptr);
  }
  std::printf("%llu forces were sent, the largest %.3f N\n",
              static_cast<unsigned long long>(device.sends - begin), most);
  return most > 0 ? 0 : 1;
}
