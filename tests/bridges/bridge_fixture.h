// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include <sys/wait.h>

#include <gtest/gtest.h>

#include "artus/session/shared_memory_device.h"
#include "tests/bridges/stand_in.h"

namespace artus::test {

inline std::int64_t clock_ns() {
  return static_cast<std::int64_t>(artus_shm_now_ns());
}

inline bool comes(const std::function<bool()>& wanted, int ms = 10'000) {
  for (int i = 0; i < ms && !wanted(); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  return wanted();
}

/// A process that does what artus does at 1 kHz: it answers every pose with 1 N, upwards on the
/// needle's hand and downwards on the probe's.
inline pid_t start_artus(const std::string& prefix) {
  const pid_t process = fork();
  if (process != 0) return process;
  auto device = SharedMemoryDevice::open(prefix, {"outside"});
  if (!device) _exit(3);
  for (;;) {
    const DeviceSample sample = (*device)->read(clock_ns());
    DeviceFeedback feedback{};
    feedback.tick = static_cast<std::uint64_t>(clock_ns()) / 1'000'000;
    feedback.time_ns = clock_ns();
    feedback.answers = sample.number;
    feedback.sample_time_ns = sample.time_ns;
    if (sample.state == PeerState::alive) {
      feedback.force[2] = sample.has_needle != 0 ? 1 : 0;
      feedback.probe_force[2] = sample.has_probe != 0 ? -1 : 0;
    }
    (*device)->write(feedback);
    std::this_thread::sleep_for(std::chrono::microseconds(500));
  }
}

/// A bridge program of this build, with the stand-ins in the place of makers' libraries.
inline pid_t start_bridge(const std::string& program, std::vector<std::string> arguments,
                          const std::vector<std::string>& environment) {
  const std::string path = std::string(ARTUS_BRIDGES) + "/artus-bridge-" + program;
  arguments.insert(arguments.begin(), path);
  const pid_t process = fork();
  if (process != 0) return process;
  for (const std::string& entry : environment) putenv(strdup(entry.c_str()));
  setenv("LD_LIBRARY_PATH", ARTUS_STAND_INS, 1);
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  execv(path.c_str(), argv.data());
  _exit(127);
}

/// Its exit code; -1 where a signal ended it.
inline int end_process(pid_t process, int number) {
  kill(process, number);
  int status = 0;
  waitpid(process, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

}  // namespace artus::test
