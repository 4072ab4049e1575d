// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/session/session_thread.h"

#include <cerrno>
#include <cmath>
#include <ctime>
#include <system_error>

#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

namespace artus {
namespace {
constexpr std::int64_t kSecond = 1'000'000'000;  // ns

std::string reason(int error) {
  return std::generic_category().message(error);
}
}  // namespace

std::int64_t monotonic_ns() noexcept {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return now.tv_sec * kSecond + now.tv_nsec;
}

std::int64_t thread_cpu_ns() noexcept {
  timespec used{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &used);
  return used.tv_sec * kSecond + used.tv_nsec;
}

PeriodicSchedule::PeriodicSchedule(double rate_hz) noexcept
    : period_(std::llround(1e9 / rate_hz)), due_(monotonic_ns()) {}

std::int64_t PeriodicSchedule::wait() noexcept {
  due_ += period_;
  const timespec due{due_ / kSecond, due_ % kSecond};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &due, nullptr) == EINTR) {
  }
  const std::int64_t late = monotonic_ns() - due_;
  if (late >= period_) {
    ++overruns_;
    due_ += late / period_ * period_;
  }
  return late;
}

std::vector<std::string> request_from_system(const ThreadOptions& options) {
  std::vector<std::string> refused;
  if (options.fifo_priority > 0) {
    sched_param param{};
    param.sched_priority = options.fifo_priority;
    const int error = pthread_setschedparam(pthread_self(), SCHED_FIFO, &param);
    if (error != 0) refused.push_back("SCHED_FIFO priority: " + reason(error));
  }
  if (options.nice != 0 &&
      setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), options.nice) != 0) {
    refused.push_back("nice value " + std::to_string(options.nice) + ": " + reason(errno));
  }
  if (options.lock_memory && mlockall(MCL_CURRENT) != 0) {
    refused.push_back("locking memory: " + reason(errno));
  }
  if (options.cpu >= 0) {
    cpu_set_t set;
    CPU_ZERO(&set);
    CPU_SET(static_cast<unsigned>(options.cpu), &set);
    const int error = pthread_setaffinity_np(pthread_self(), sizeof set, &set);
    if (error != 0) refused.push_back("one processor: " + reason(error));
  }
  return refused;
}

}  // namespace artus
