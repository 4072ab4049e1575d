// SPDX-License-Identifier: AGPL-3.0-or-later
// Touch, Touch X and older Phantoms by OpenHaptics' HD API (libHD). Prototypes and numbers are
// those that 3D Systems publishes in its programmer's guide. Never run on hardware.
#include <algorithm>
#include <chrono>
#include <thread>

#include "driver.h"
#include "library.h"

namespace artus::bridge {
namespace {

using Handle = std::uint32_t;
struct HdError {  // 12 bytes, returned by value
  std::uint32_t code;
  std::int32_t internal;
  Handle device;
};
static_assert(sizeof(HdError) == 12, "as the library returns it");

constexpr Handle kNoDevice = 0xFFFFFFFF;
constexpr std::uint32_t kForceOutput = 0x4000;
constexpr std::uint32_t kButtons = 0x2000;
constexpr std::uint32_t kTransform = 0x2052;
constexpr std::uint32_t kForce = 0x2700;
constexpr std::uint32_t kForceErrors = 0x0200;  // warm motors, exceeded force or speed: 0x02..
constexpr std::uint16_t kPriority = 0x7FFF;
constexpr std::uint32_t kGoOn = 1;
constexpr std::uint32_t kDone = 0;

/// The functions of libHD.
struct HdLibrary {
  Library library{"libHD.so", "libHD.so.3.0", "libHD.so.3.4"};
  Handle (*init)(const char*) = nullptr;
  void (*disable)(Handle) = nullptr;
  void (*make_current)(Handle) = nullptr;
  void (*enable)(std::uint32_t) = nullptr;
  void (*begin)(Handle) = nullptr;
  void (*end)(Handle) = nullptr;
  void (*get_doubles)(std::uint32_t, double*) = nullptr;
  void (*get_integers)(std::uint32_t, int*) = nullptr;
  void (*set_doubles)(std::uint32_t, const double*) = nullptr;
  unsigned long (*schedule)(std::uint32_t (*)(void*), void*, std::uint16_t) = nullptr;
  void (*unschedule)(unsigned long) = nullptr;
  void (*start)() = nullptr;
  void (*stop)() = nullptr;
  HdError (*error)() = nullptr;

  HdLibrary() {
    library.find("hdInitDevice", init);
    library.find("hdDisableDevice", disable);
    library.find("hdMakeCurrentDevice", make_current);
    library.find("hdEnable", enable);
    library.find("hdBeginFrame", begin);
    library.find("hdEndFrame", end);
    library.find("hdGetDoublev", get_doubles);
    library.find("hdGetIntegerv", get_integers);
    library.find("hdSetDoublev", set_doubles);
    library.find("hdScheduleAsynchronous", schedule);
    library.find("hdUnschedule", unschedule);
    library.find("hdStartScheduler", start);
    library.find("hdStopScheduler", stop);
    library.find("hdGetError", error);
  }
  /// The oldest error of a device; the queue, which all devices share, is emptied.
  [[nodiscard]] std::uint32_t take_error(Handle of) const {
    constexpr int kQueue = 16;
    std::uint32_t first = 0;
    for (int i = 0; i < kQueue; ++i) {
      const HdError told = error();
      if (told.code == 0) break;
      if (first == 0 && told.device == of) first = told.code;
    }
    return first;
  }
};

class TouchDevice final : public Device {
 public:
  TouchDevice(const HdLibrary& hd, Handle handle) : hd_(hd), handle_(handle) {}
  ~TouchDevice() override { hd_.disable(handle_); }

  std::string run(const Tick& tick, const std::atomic<bool>& stop) override {
    tick_ = &tick;
    stop_ = &stop;
    done_ = false;
    const unsigned long scheduled = hd_.schedule(&TouchDevice::called, this, kPriority);
    hd_.start();
    while (!done_) std::this_thread::sleep_for(std::chrono::milliseconds(2));
    hd_.unschedule(scheduled);
    return lost_;
  }

 private:
  static std::uint32_t called(void* self) { return static_cast<TouchDevice*>(self)->servo(); }

  /// In the scheduler's thread, 1 kHz.
  std::uint32_t servo() {
    if (done_) return kDone;
    hd_.begin(handle_);
    hd_.make_current(handle_);
    const Triple force = stop_->load() ? Triple{} : (*tick_)(read());
    const double out[3] = {force[0], force[1], force[2]};
    hd_.set_doubles(kForce, out);
    hd_.end(handle_);
    const std::uint32_t code = hd_.take_error(handle_);
    faults_ = code == 0 ? 0 : faults_ + 1;
    forced_ = code >= kForceErrors && code < kForceErrors + 0x100;
    constexpr int kMostFaults = 10;  // ticks
    if (code != 0 && !forced_ && faults_ >= kMostFaults)
      lost_ = "error " + std::to_string(code) + " of libHD";
    if (lost_.empty() && !stop_->load()) return kGoOn;
    send_nothing();
    done_ = true;
    return kDone;
  }

  Reading read() const {
    Reading reading;
    double m[16] = {};  // columns of the tool's frame, mm
    int buttons = 0;
    hd_.get_doubles(kTransform, m);
    hd_.get_integers(kButtons, &buttons);
    reading.sound = faults_ == 0 && m[15] == 1;
    reading.has_wrist = true;
    for (std::size_t i = 0; i < 3; ++i) {
      reading.position[i] = 1e-3 * m[12 + i];
      for (std::size_t j = 0; j < 3; ++j) reading.rotation[3 * i + j] = m[4 * j + i];
    }
    reading.buttons = static_cast<std::uint32_t>(buttons);
    return reading;
  }

  void send_nothing() const {
    const double none[3] = {0, 0, 0};
    hd_.begin(handle_);
    hd_.make_current(handle_);
    hd_.set_doubles(kForce, none);
    hd_.end(handle_);
  }

  const HdLibrary& hd_;
  Handle handle_;
  const Tick* tick_ = nullptr;
  const std::atomic<bool>* stop_ = nullptr;
  std::string lost_;  // written before done_
  std::atomic<bool> done_{false};
  int faults_ = 0;
  bool forced_ = false;
};

class TouchDriver final : public Driver {
 public:
  std::unique_ptr<Device> open(const std::string& name, std::string& why) override {
    if (!hd_.library.why().empty()) {
      why = hd_.library.why();
      return nullptr;
    }
    static_cast<void>(hd_.take_error(kNoDevice));  // of whoever asked before
    const Handle handle = hd_.init(name.empty() ? nullptr : name.c_str());
    const std::uint32_t code = hd_.take_error(handle);
    if (handle == kNoDevice || code != 0) {
      why = "hdInitDevice gives error " + std::to_string(code) +
            "; is it configured under GTDD_HOME, and does no other program hold it?";
      return nullptr;
    }
    hd_.make_current(handle);
    hd_.enable(kForceOutput);
    return std::make_unique<TouchDevice>(hd_, handle);
  }
  std::string describe() override {
    return hd_.library.why().empty() ? "libHD is there; devices are named in GTDD_HOME"
                                     : hd_.library.why();
  }
  [[nodiscard]] HandLimits limits() const override { return {3.3, 0.88}; }
  [[nodiscard]] Triple workspace() const override { return {160, 120, 70}; }
  [[nodiscard]] const char* maker() const override { return "Touch (OpenHaptics)"; }

 private:
  HdLibrary hd_;
};

}  // namespace
}  // namespace artus::bridge

int main(int argc, char** argv) {
  artus::bridge::TouchDriver driver;
  return artus::bridge::run_program(argc, argv, driver);
}
