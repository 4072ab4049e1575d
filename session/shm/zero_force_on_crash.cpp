// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/session/shm/zero_force_on_crash.h"

#include <cerrno>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include <unistd.h>

#include "artus/session/client/artus_shm.h"

namespace artus {
namespace {

constexpr int kFatal[] = {SIGSEGV, SIGABRT, SIGFPE, SIGILL, SIGSYS, SIGQUIT};

template <class T>
bool put(int file, std::size_t at, const T& value) noexcept {
  return pwrite(file, &value, sizeof value, static_cast<off_t>(at)) == sizeof value;
}

/// Writes the last force through the file: the mapping was taken from this process before, so that
/// no other thread of it can write another one afterwards. System calls only: runs in handlers.
bool write_last_force(int file) noexcept {
  artus_shm_header head{};
  if (pread(file, &head, sizeof head, 0) != static_cast<ssize_t>(sizeof head)) return false;
  artus_shm_force last{};
  last.status = ARTUS_SHM_STOPPED;
  last.time_ns = artus_shm_now_ns();
  const std::uint64_t writing = head.sequence | 1U;  // a write may have been cut off
  return put(file, offsetof(artus_shm_header, sequence), writing) && put(file, sizeof head, last) &&
         put(file, offsetof(artus_shm_header, sequence), writing + 1) &&
         put(file, offsetof(artus_shm_header, heartbeat), head.heartbeat + 1) &&
         put(file, offsetof(artus_shm_header, writer_pid), std::uint64_t{0});
}

void send_zero_force() noexcept {
  const int saved = errno;
  for (artus_shm_range& range : artus_shm_ranges) {
    if (__atomic_load_n(&range.base, __ATOMIC_ACQUIRE) <= 1 || range.force == 0) continue;
    if (artus_shm_detach(&range) == 0) static_cast<void>(write_last_force(range.file));
  }
  errno = saved;
}

void on_fatal(int number) noexcept {
  send_zero_force();
  ::signal(number, SIG_DFL);
  ::raise(number);
}

}  // namespace

void install_zero_force_on_crash() {
  artus_shm_guard_all();  // first in the row for SIGBUS, before the handler below
  struct sigaction action {};
  action.sa_handler = on_fatal;
  action.sa_flags = SA_NODEFER;
  for (const int number : kFatal) sigaction(number, &action, nullptr);
  artus_shm_former_sigbus = action;  // what no segment of ours caused
  std::atexit(send_zero_force);
}

}  // namespace artus
