// SPDX-License-Identifier: AGPL-3.0-or-later
// A stand-in of Force Dimension's libdhd: the published functions, devices 0 and 1.
#include "tests/bridges/stand_in.h"

namespace {

artus::test::StandIn* memory() {
  static artus::test::StandIn* one = artus::test::map_stand_in();
  return one;
}
artus::test::StandInDevice& device(char id) {
  return memory()->devices[id & 1];
}
bool fails(char id) {
  return device(id).plugged == 0 || device(id).error != 0;
}

struct TwoNumbers {
  double a;
  double b;
};

}  // namespace

extern "C" {
int dhdGetDeviceCount() {
  return memory()->devices[0].plugged + memory()->devices[1].plugged;
}
int dhdOpenID(char id) {
  if (fails(id)) return -1;
  ++device(id).opened;
  return id;
}
int dhdClose(char) {
  return 0;
}
int dhdEnableForce(unsigned char, char) {
  return 0;
}
int dhdSetGravityCompensation(int, char) {
  return 0;
}
int dhdGetPositionAndOrientationFrame(double* x, double* y, double* z, double (*m)[3], char id) {
  if (fails(id)) return -1;
  *x = device(id).position[0];
  *y = device(id).position[1];
  *z = device(id).position[2];
  for (int i = 0; i < 9; ++i) m[i / 3][i % 3] = artus::test::rotation_of(device(id), i / 3, i % 3);
  return 0;
}
// Six doubles and a number: pairs of doubles come in the same registers.
int dhdSetForceAndTorque(TwoNumbers first, TwoNumbers second, TwoNumbers /*torque*/, char id) {
  device(id).force[0] = first.a;
  device(id).force[1] = first.b;
  device(id).force[2] = second.a;
  ++device(id).sends;
  return fails(id) ? -1 : 1;  // 1: the library's guard of time, no error
}
unsigned dhdGetButtonMask(char id) {
  return device(id).buttons;
}
bool dhdHasWrist(char) {
  return true;
}
const char* dhdErrorGetLastStr() {
  return "no device found";
}
}
