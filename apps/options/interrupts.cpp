// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/apps/options/interrupts.h"

#include <cmath>
#include <ctime>
#include <initializer_list>

#include "artus/detail/session/shm/zero_force_on_crash.h"

namespace artus {

Interrupts::Interrupts() {
  install_zero_force_on_crash();
  sigemptyset(&set_);
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) sigaddset(&set_, number);
  pthread_sigmask(SIG_BLOCK, &set_, &before_);
  std::signal(SIGPIPE, SIG_IGN);
}

Interrupts::~Interrupts() {
  if (wait(0)) came_ = true;  // one that came during the end has had its way
  pthread_sigmask(SIG_SETMASK, &before_, nullptr);
}

bool Interrupts::wait(double seconds) noexcept {
  const double whole = std::floor(seconds);
  const timespec pause{static_cast<time_t>(whole), static_cast<long>(1e9 * (seconds - whole))};
  if (!came_ && sigtimedwait(&set_, nullptr, &pause) > 0) came_ = true;
  return came_;
}

}  // namespace artus
