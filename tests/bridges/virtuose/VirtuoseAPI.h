/* SPDX-License-Identifier: AGPL-3.0-or-later
 * Stand-in of the functions of Haption's Virtuose API that the bridge calls, so that it is compiled
 * and run without the SDK: names and arguments as its manual publishes them. */
#pragma once
#ifdef __cplusplus
extern "C" {
#endif
typedef void* VirtContext;
typedef enum { COMMAND_TYPE_NONE, COMMAND_TYPE_IMPEDANCE } VirtCommandType;
VirtContext virtOpen(const char* address);
int virtClose(VirtContext context);
int virtSetTimeStep(VirtContext context, float seconds);
int virtSetCommandType(VirtContext context, VirtCommandType type);
int virtSetForceFactor(VirtContext context, float factor);
int virtSetSpeedFactor(VirtContext context, float factor);
int virtSaturateTorque(VirtContext context, float force, float torque);
int virtSetPowerOn(VirtContext context, int on);
int virtGetPosition(VirtContext context, float* pose);
int virtSetForce(VirtContext context, float* force);
int virtGetButton(VirtContext context, int button, int* down);
int virtGetErrorCode(VirtContext context);
const char* virtGetErrorMessage(int code);
#ifdef __cplusplus
}
#endif
