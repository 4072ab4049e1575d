// SPDX-License-Identifier: AGPL-3.0-or-later
// Real processes that die in the middle of a force: the last thing in FORCE is zero.
#include <csignal>
#include <cstdlib>
#include <exception>
#include <stdexcept>
#include <thread>

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <gtest/gtest.h>

#include "artus/detail/session/session_thread.h"
#include "artus/detail/session/shm/zero_force_on_crash.h"
#include "artus/session/shared_memory_device.h"

namespace artus {
namespace {

/// A process with a thread that writes 2 N as fast as it can until `told` says something, and then
/// `death`.
void write_forces_until(int told, const std::string& prefix, void (*death)()) {
  const rlimit none{0, 0};
  setrlimit(RLIMIT_CORE, &none);
  install_zero_force_on_crash();
  auto device = SharedMemoryDevice::open(prefix, {});
  if (!device) _exit(3);
  std::thread writer([&device] {
    for (std::uint64_t tick = 1;; ++tick) {
      DeviceFeedback feedback;
      feedback.tick = tick;
      feedback.force[2] = 2;
      feedback.time_ns = monotonic_ns();
      (*device)->write(feedback);
    }
  });
  char byte = 0;
  if (read(told, &byte, 1) == 1) death();
  _exit(4);
}

struct Death {
  const char* name;
  void (*die)();
};

void access_nothing() {
  volatile int* nothing = nullptr;
  *nothing = 1;
}
void throw_in_a_thread() {
  std::thread([] { throw std::runtime_error("a thread's own"); }).join();
}
void leave_by_exit() {
  std::exit(0);  // NOLINT(concurrency-mt-unsafe): that is the point
}

class Dying : public ::testing::TestWithParam<Death> {
 protected:
  ~Dying() override {
    SharedSegment::remove(prefix_, kPosLayout);
    SharedSegment::remove(prefix_, kForceLayout);
  }
  std::string prefix_ = "artus-dying-" + std::to_string(getpid()) + "-";
};

TEST_P(Dying, LeavesZeroForceBehind) {
  // Made before, so that it is still there when the process is not.
  const auto seen =
      SharedChannel<artus_shm_force>::open(prefix_, kForceLayout, SegmentAccess::owner_reads);
  ASSERT_TRUE(seen);
  for (int round = 0; round < 5; ++round) {
    int tell[2];
    ASSERT_EQ(pipe(tell), 0);
    const pid_t process = fork();
    if (process == 0) write_forces_until(tell[0], prefix_, GetParam().die);
    artus_shm_force force{};
    const std::int64_t patience = monotonic_ns() + 20'000'000'000;
    while (force.force[2] != 2 && monotonic_ns() < patience) static_cast<void>(seen->read(force));
    EXPECT_EQ(force.force[2], 2);
    EXPECT_EQ(write(tell[1], "!", 1), 1);
    waitpid(process, nullptr, 0);
    ASSERT_TRUE(seen->read(force)) << "whole";
    EXPECT_EQ(force.force[2], 0);
    EXPECT_EQ(force.status, static_cast<std::uint32_t>(ARTUS_SHM_STOPPED));
    EXPECT_EQ(seen->segment().writer_pid(), 0U);
    close(tell[0]);
    close(tell[1]);
  }
}

INSTANTIATE_TEST_SUITE_P(Paths, Dying,
                         ::testing::Values(Death{"Terminate",
                                                 [] {
                                                   std::terminate();
                                                 }},
                                           Death{"AnExceptionInAThread", throw_in_a_thread},
                                           Death{"Abort",
                                                 [] {
                                                   std::abort();
                                                 }},
                                           Death{"AnAddressThatIsNone", access_nothing},
                                           Death{"Quit",
                                                 [] {
                                                   raise(SIGQUIT);
                                                 }},
                                           Death{"Exit", leave_by_exit}),
                         [](const auto& path) { return std::string(path.param.name); });

}  // namespace
}  // namespace artus
