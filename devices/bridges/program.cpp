// SPDX-License-Identifier: AGPL-3.0-or-later
#include <csignal>
#include <cstdio>
#include <cstring>
#include <thread>

#include <pthread.h>
#include <sched.h>

#include "bridge.h"
#include "check.h"

namespace artus::bridge {
namespace {

/// Waits for a signal, or so long; signals are blocked in every thread.
void wait_for_end(double seconds) {
  sigset_t set;
  sigemptyset(&set);
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) sigaddset(&set, number);
  if (seconds <= 0) {
    int number = 0;
    sigwait(&set, &number);
    return;
  }
  timespec time{};
  time.tv_sec = static_cast<time_t>(seconds);
  time.tv_nsec = static_cast<long>(1e9 * (seconds - static_cast<double>(time.tv_sec)));
  sigtimedwait(&set, nullptr, &time);
}

void block_signals() {
  sigset_t set;
  sigemptyset(&set);
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) sigaddset(&set, number);
  pthread_sigmask(SIG_BLOCK, &set, nullptr);
}

/// The thread is served before others where the system allows it.
void be_punctual() {
  sched_param how{};
  how.sched_priority = 40;
  pthread_setschedparam(pthread_self(), SCHED_FIFO, &how);
}

/// Opens a device, runs it, and tries again each second when it is lost.
void keep(Driver& driver, Bridge& bridge, const ChosenDevice& chosen, std::size_t number,
          const std::atomic<bool>& stop) {
  be_punctual();
  std::string last;
  const auto tell = [&](const std::string& what) {
    if (what == last) return;
    last = what;
    std::fprintf(stderr, "%s '%s': %s\n", driver.maker(), chosen.name.c_str(), what.c_str());
  };
  while (!stop) {
    std::string why;
    if (const auto device = driver.open(chosen.name, why)) {
      tell(chosen.probe ? "is the probe" : "is the needle");
      why = device->run([&](const Reading& reading) { return bridge.tick(number, reading); }, stop);
      bridge.lose(number);
      if (!why.empty()) why = "lost: " + why;
    }
    if (stop) return;
    tell(why + "; it is tried again each second");
    for (int i = 0; i < 100 && !stop; ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
}

int run_bridge(Driver& driver, const Options& options) {
  artus_shm_link link;
  const bool probe_alone = options.devices.size() == 1 && options.devices.front().probe;
  if (artus_shm_open_role(&link, options.prefix.c_str(),
                          probe_alone ? ARTUS_SHM_ROLE_PROBE : ARTUS_SHM_ROLE_ALL) != 0) {
    std::fprintf(stderr, "%s: %s\n", link.refusal, std::strerror(errno));
    return 1;
  }
  Bridge bridge(link, options);
  std::atomic<bool> stop{false};
  std::vector<std::thread> threads;
  for (std::size_t i = 0; i < options.devices.size(); ++i)
    threads.emplace_back([&, i] { keep(driver, bridge, options.devices[i], i, stop); });
  wait_for_end(options.seconds);
  stop = true;
  for (std::thread& thread : threads) thread.join();
  artus_shm_close(&link);
  if (options.statistics) std::printf("%s\n", bridge.statistics().c_str());
  return 0;
}

}  // namespace

int run_program(int argc, char** argv, Driver& driver) {
  for (int i = 1; i < argc; ++i)
    if (std::strcmp(argv[i], "--help") == 0 || std::strcmp(argv[i], "-h") == 0) {
      std::fputs(help(driver).c_str(), stdout);
      return 0;
    }
  Options options;
  const std::string wrong = parse_options(argc, argv, driver, options);
  if (!wrong.empty()) {
    std::fprintf(stderr, "%s\n", wrong.c_str());
    return 2;
  }
  if (options.list) {
    std::printf("%s: %s\n", driver.maker(), driver.describe().c_str());
    return 0;
  }
  if (options.limits) {
    std::fputs(device_file(driver).c_str(), stdout);
    return 0;
  }
  block_signals();
  return options.check ? run_check(driver, options) : run_bridge(driver, options);
}

}  // namespace artus::bridge
