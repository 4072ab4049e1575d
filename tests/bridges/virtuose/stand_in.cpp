// SPDX-License-Identifier: AGPL-3.0-or-later
// A stand-in of Haption's library over the memory that the test maps: controllers "0" and "1".
#include "tests/bridges/stand_in.h"

#include <cstdlib>

#include "VirtuoseAPI.h"

namespace {

artus::test::StandIn* memory() {
  static artus::test::StandIn* one = artus::test::map_stand_in();
  return one;
}
artus::test::StandInDevice& device(VirtContext context) {
  return *static_cast<artus::test::StandInDevice*>(context);
}
int result(VirtContext context) {
  return device(context).plugged == 0 || device(context).error != 0 ? -1 : 0;
}

}  // namespace

extern "C" {
VirtContext virtOpen(const char* address) {
  auto& one = memory()->devices[std::atoi(address) & 1];
  if (one.plugged == 0 || one.error != 0) return nullptr;
  ++one.opened;
  return &one;
}
int virtClose(VirtContext /*context*/) {
  return 0;
}
int virtSetTimeStep(VirtContext context, float /*seconds*/) {
  return result(context);
}
int virtSetCommandType(VirtContext context, VirtCommandType /*type*/) {
  return result(context);
}
int virtSetForceFactor(VirtContext context, float /*factor*/) {
  return result(context);
}
int virtSetSpeedFactor(VirtContext context, float /*factor*/) {
  return result(context);
}
int virtSaturateTorque(VirtContext context, float /*force*/, float /*torque*/) {
  return result(context);
}
int virtSetPowerOn(VirtContext context, int /*on*/) {
  return result(context);
}
int virtGetPosition(VirtContext context, float* pose) {
  for (int i = 0; i < 3; ++i) pose[i] = static_cast<float>(device(context).position[i]);
  pose[3] = pose[4] = pose[5] = 0;
  pose[6] = 1;
  return result(context);
}
int virtSetForce(VirtContext context, float* force) {
  for (int i = 0; i < 3; ++i) device(context).force[i] = static_cast<double>(force[i]);
  ++device(context).sends;
  return result(context);
}
int virtGetButton(VirtContext context, int button, int* down) {
  *down = static_cast<int>(device(context).buttons >> button & 1U);
  return result(context);
}
int virtGetErrorCode(VirtContext context) {
  return device(context).error;
}
const char* virtGetErrorMessage(int /*code*/) {
  return "no connection";
}
}
