// SPDX-License-Identifier: AGPL-3.0-or-later
// Devices of Haption by the Virtuose API, built against the owner's own SDK (ARTUS_VIRTUOSE_SDK):
// its library is static and its header calls it inline. Never run on hardware.
#include <chrono>
#include <thread>

#include <VirtuoseAPI.h>

#include "driver.h"

namespace artus::bridge {
namespace {

constexpr float kPeriod = 1e-3F;  // s
constexpr float kMostTorque = 1;  // N m: none is sent, the controller limits all the same
constexpr int kButtons = 3;

/// Rows of the turn of a quaternion x y z w.
Turn turn_of(const float* q) {
  const double x = q[0];
  const double y = q[1];
  const double z = q[2];
  const double w = q[3];
  return {1 - 2 * (y * y + z * z), 2 * (x * y - w * z),     2 * (x * z + w * y),
          2 * (x * y + w * z),     1 - 2 * (x * x + z * z), 2 * (y * z - w * x),
          2 * (x * z - w * y),     2 * (y * z + w * x),     1 - 2 * (x * x + y * y)};
}

class VirtuoseDevice final : public Device {
 public:
  explicit VirtuoseDevice(VirtContext context) : context_(context) {}
  ~VirtuoseDevice() override {
    virtSetPowerOn(context_, 0);
    virtClose(context_);
  }
  VirtuoseDevice(const VirtuoseDevice&) = delete;
  VirtuoseDevice& operator=(const VirtuoseDevice&) = delete;

  std::string run(const Tick& tick, const std::atomic<bool>& stop) override {
    auto next = std::chrono::steady_clock::now();
    std::string lost;
    while (!stop && lost.empty()) {
      const Triple force = tick(read());
      float sent[6] = {static_cast<float>(force[0]),
                       static_cast<float>(force[1]),
                       static_cast<float>(force[2]),
                       0,
                       0,
                       0};
      if (virtSetForce(context_, sent) != 0) lost = virtGetErrorMessage(virtGetErrorCode(context_));
      next += std::chrono::milliseconds(1);
      const auto now = std::chrono::steady_clock::now();
      if (next < now) next = now;
      std::this_thread::sleep_until(next);
    }
    float none[6] = {0, 0, 0, 0, 0, 0};
    virtSetForce(context_, none);
    return lost;
  }

 private:
  [[nodiscard]] Reading read() {
    Reading reading;
    float pose[7] = {};  // m, then x y z w
    reading.sound = virtGetPosition(context_, pose) == 0;
    reading.has_wrist = true;
    for (std::size_t i = 0; i < 3; ++i) reading.position[i] = static_cast<double>(pose[i]);
    reading.rotation = turn_of(pose + 3);
    for (int button = 0; button < kButtons; ++button) {
      int down = 0;
      if (virtGetButton(context_, button, &down) == 0 && down != 0)
        reading.buttons |= 1U << static_cast<unsigned>(button);
    }
    return reading;
  }

  VirtContext context_;
};

class VirtuoseDriver final : public Driver {
 public:
  std::unique_ptr<Device> open(const std::string& name, std::string& why) override {
    if (name.empty()) {
      why = "name the controller's address: virtuose:192.168.100.51";
      return nullptr;
    }
    const VirtContext context = virtOpen(name.c_str());
    if (context == nullptr) {
      why = "no controller answers at " + name;
      return nullptr;
    }
    auto device = std::make_unique<VirtuoseDevice>(context);
    const bool set =
        virtSetTimeStep(context, kPeriod) == 0 &&
        virtSetCommandType(context, COMMAND_TYPE_IMPEDANCE) == 0 &&
        virtSetForceFactor(context, 1) == 0 && virtSetSpeedFactor(context, 1) == 0 &&
        virtSaturateTorque(context, static_cast<float>(limits().peak), kMostTorque) == 0 &&
        virtSetPowerOn(context, 1) == 0;
    if (set) return device;
    why = virtGetErrorMessage(virtGetErrorCode(context));
    return nullptr;
  }
  std::string describe() override { return "built in; devices are named by their address"; }
  [[nodiscard]] HandLimits limits() const override { return {10, 3}; }
  [[nodiscard]] Triple workspace() const override { return {450, 450, 450}; }
  /// x to the user, y right, z up.
  [[nodiscard]] Turn axes() const override { return {0, 1, 0, -1, 0, 0, 0, 0, 1}; }
  [[nodiscard]] const char* maker() const override { return "Virtuose (Haption)"; }
};

}  // namespace
}  // namespace artus::bridge

int main(int argc, char** argv) {
  artus::bridge::VirtuoseDriver driver;
  return artus::bridge::run_program(argc, argv, driver);
}
