// SPDX-License-Identifier: AGPL-3.0-or-later
// Omega, Sigma, Delta and Novint's Falcon by the library libdhd of [ForceDimension]. Prototypes are
// those that its header publishes for C; the device's number, which C++ may leave out, is always
// passed. Never run on hardware.
#include <cstdlib>

#include <time.h>

#include "driver.h"
#include "library.h"

namespace artus::bridge {
namespace {

constexpr int kTimeGuard = 1;        // no error: the force was sent less than a period ago
constexpr long kPeriod = 1'000'000;  // ns

struct DhdLibrary {
  Library library{"libdhd.so.3", "libdhd.so"};
  int (*count)() = nullptr;
  int (*open_id)(char) = nullptr;
  int (*close)(char) = nullptr;
  int (*enable_force)(unsigned char, char) = nullptr;
  int (*set_gravity)(int, char) = nullptr;
  int (*get_frame)(double*, double*, double*, double (*)[3], char) = nullptr;
  int (*set_force)(double, double, double, double, double, double, char) = nullptr;
  unsigned (*buttons)(char) = nullptr;
  bool (*has_wrist)(char) = nullptr;
  const char* (*last_error)() = nullptr;

  DhdLibrary() {
    library.find("dhdGetDeviceCount", count);
    library.find("dhdOpenID", open_id);
    library.find("dhdClose", close);
    library.find("dhdEnableForce", enable_force);
    library.find("dhdSetGravityCompensation", set_gravity);
    library.find("dhdGetPositionAndOrientationFrame", get_frame);
    library.find("dhdSetForceAndTorque", set_force);
    library.find("dhdGetButtonMask", buttons);
    library.find("dhdHasWrist", has_wrist);
    library.find("dhdErrorGetLastStr", last_error);
  }
};

class DhdDevice final : public Device {
 public:
  DhdDevice(const DhdLibrary& dhd, char id) : dhd_(dhd), id_(id), wrist_(dhd.has_wrist(id)) {}
  ~DhdDevice() override {
    dhd_.set_force(0, 0, 0, 0, 0, 0, id_);
    dhd_.enable_force(0, id_);
    dhd_.close(id_);
  }

  std::string run(const Tick& tick, const std::atomic<bool>& stop) override {
    timespec next{};
    clock_gettime(CLOCK_MONOTONIC, &next);
    constexpr int kMostFaults = 10;  // ticks
    int faults = 0;
    while (!stop) {
      const Reading reading = read();
      const Triple force = tick(reading);  // zero where the reading is not sound
      const int sent = dhd_.set_force(force[0], force[1], force[2], 0, 0, 0, id_);
      const bool good = reading.sound && (sent == 0 || sent == kTimeGuard);
      faults = good ? 0 : faults + 1;
      if (faults == kMostFaults) {
        dhd_.set_force(0, 0, 0, 0, 0, 0, id_);
        return dhd_.last_error();
      }
      next.tv_nsec += kPeriod;
      if (next.tv_nsec >= 1'000'000'000) {
        next.tv_nsec -= 1'000'000'000;
        ++next.tv_sec;
      }
      clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &next, nullptr);
    }
    dhd_.set_force(0, 0, 0, 0, 0, 0, id_);
    return "";
  }

 private:
  [[nodiscard]] Reading read() const {
    Reading reading;
    double m[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    double* p = reading.position.data();
    reading.sound = dhd_.get_frame(p, p + 1, p + 2, m, id_) >= 0;
    reading.has_wrist = wrist_;
    for (std::size_t i = 0; i < 9; ++i) reading.rotation[i] = m[i / 3][i % 3];
    reading.buttons = dhd_.buttons(id_);
    return reading;
  }

  const DhdLibrary& dhd_;
  char id_;
  bool wrist_;
};

class DhdDriver final : public Driver {
 public:
  std::unique_ptr<Device> open(const std::string& name, std::string& why) override {
    why = dhd_.library.why();
    if (!why.empty()) return nullptr;
    char* end = nullptr;
    const long number = name.empty() ? 0 : std::strtol(name.c_str(), &end, 10);
    if (!name.empty() && (*end != '\0' || number < 0 || number > 15)) {
      why = "devices are named by their number, from 0";
      return nullptr;
    }
    const int id = dhd_.open_id(static_cast<char>(number));
    if (id < 0) {
      why = dhd_.last_error();
      return nullptr;
    }
    const auto opened = static_cast<char>(id);
    dhd_.set_gravity(1, opened);
    dhd_.enable_force(1, opened);
    return std::make_unique<DhdDevice>(dhd_, opened);
  }
  std::string describe() override {
    if (!dhd_.library.why().empty()) return dhd_.library.why();
    return std::to_string(dhd_.count()) + " devices";
  }
  [[nodiscard]] HandLimits limits() const override { return {8, 8}; }
  [[nodiscard]] Triple workspace() const override { return {160, 160, 110}; }
  /// x to the user, y right, z up.
  [[nodiscard]] Turn axes() const override { return {0, 1, 0, -1, 0, 0, 0, 0, 1}; }
  [[nodiscard]] const char* maker() const override { return "Force Dimension, Falcon"; }

 private:
  DhdLibrary dhd_;
};

}  // namespace
}  // namespace artus::bridge

int main(int argc, char** argv) {
  artus::bridge::DhdDriver driver;
  return artus::bridge::run_program(argc, argv, driver);
}
