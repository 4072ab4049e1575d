// SPDX-License-Identifier: AGPL-3.0-or-later
// A stand-in of OpenHaptics' libHD: the published functions, a scheduler of 1 kHz, devices A and B.
#include <cstring>
#include <mutex>
#include <thread>
#include <vector>

#include <time.h>

#include "tests/bridges/stand_in.h"

namespace {

struct HdErrorInfo {
  std::uint32_t code;
  std::int32_t internal;
  std::uint32_t device;
};
using Callback = std::uint32_t (*)(void*);
struct Task {
  Callback callback;
  void* data;
  unsigned long number;
};
struct Library {
  artus::test::StandIn* memory = artus::test::map_stand_in();
  std::recursive_mutex mutex;
  std::vector<Task> tasks;
  std::thread scheduler;
  std::atomic<bool> stop{false};
  unsigned long last = 0;
  std::uint32_t current = 0;
  std::uint32_t error = 0;
  std::uint32_t error_of = 0;
  ~Library() {
    stop = true;
    if (scheduler.joinable()) scheduler.join();
  }
};
Library& library() {
  static Library one;  // a library of C has its state somewhere
  return one;
}
artus::test::StandInDevice& device() {
  return library().memory->devices[library().current & 1U];
}
void run_scheduler() {
  Library& hd = library();
  timespec next{};
  clock_gettime(CLOCK_MONOTONIC, &next);
  while (!hd.stop) {
    {
      const std::lock_guard<std::recursive_mutex> lock(hd.mutex);
      std::vector<Task> kept;
      for (const Task& task : std::vector<Task>(hd.tasks))
        if (task.callback(task.data) == 1) kept.push_back(task);
      hd.tasks = kept;
    }
    next.tv_nsec += 1'000'000;
    if (next.tv_nsec >= 1'000'000'000) {
      next.tv_nsec -= 1'000'000'000;
      ++next.tv_sec;
    }
    clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &next, nullptr);
  }
}

}  // namespace

extern "C" {
std::uint32_t hdInitDevice(const char* name) {
  const std::lock_guard<std::recursive_mutex> lock(library().mutex);
  const std::uint32_t number = name != nullptr && std::strcmp(name, "B") == 0 ? 1 : 0;
  if (library().memory == nullptr || library().memory->devices[number].plugged == 0) {
    library().error = 0x0301;
    library().error_of = 0xFFFFFFFF;
    return 0xFFFFFFFF;
  }
  ++library().memory->devices[number].opened;
  return number;
}
void hdDisableDevice(std::uint32_t) {}
void hdMakeCurrentDevice(std::uint32_t handle) {
  library().current = handle;
}
void hdEnable(std::uint32_t) {}
void hdBeginFrame(std::uint32_t handle) {
  library().current = handle;
  library().error_of = library().error != 0 ? library().error_of : handle;
  if (device().plugged == 0) library().error = 0x0302;
  if (device().error != 0) library().error = static_cast<std::uint32_t>(device().error.load());
}
void hdEndFrame(std::uint32_t) {}
void hdGetDoublev(std::uint32_t what, double* out) {
  if (what != 0x2052) return;
  for (int i = 0; i < 16; ++i) out[i] = i % 5 == 0 ? 1 : 0;
  for (int i = 0; i < 3; ++i) {
    out[12 + i] = 1e3 * device().position[i];
    for (int j = 0; j < 3; ++j) out[4 * j + i] = artus::test::rotation_of(device(), i, j);
  }
}
void hdGetIntegerv(std::uint32_t, int* out) {
  *out = static_cast<int>(device().buttons.load());
}
void hdSetDoublev(std::uint32_t what, const double* in) {
  if (what != 0x2700) return;
  for (int i = 0; i < 3; ++i) device().force[i] = in[i];
  ++device().sends;
}
unsigned long hdScheduleAsynchronous(Callback callback, void* data, std::uint16_t) {
  const std::lock_guard<std::recursive_mutex> lock(library().mutex);
  library().tasks.push_back({callback, data, ++library().last});
  return library().last;
}
void hdUnschedule(unsigned long number) {
  const std::lock_guard<std::recursive_mutex> lock(library().mutex);
  std::vector<Task> kept;
  for (const Task& task : library().tasks)
    if (task.number != number) kept.push_back(task);
  library().tasks = kept;
}
void hdStartScheduler() {
  const std::lock_guard<std::recursive_mutex> lock(library().mutex);
  if (!library().scheduler.joinable()) library().scheduler = std::thread(run_scheduler);
}
void hdStopScheduler() {}
HdErrorInfo hdGetError() {
  const HdErrorInfo info{library().error, 0, library().error_of};
  library().error = 0;
  return info;
}
}
