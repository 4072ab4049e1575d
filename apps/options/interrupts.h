// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <csignal>

namespace artus {

/// SIGINT, SIGTERM and SIGHUP are taken by whoever asks here, so that a session ends in good order
/// and the device's last force is zero. Make it before the session's threads start: they inherit
/// that these signals are blocked. A closed pipe (SIGPIPE) ends nothing either. A crash that
/// happens all the same leaves zero force behind, too (install_zero_force_on_crash).
class Interrupts {
 public:
  Interrupts();
  ~Interrupts();
  Interrupts(const Interrupts&) = delete;
  Interrupts& operator=(const Interrupts&) = delete;

  /// Waits for one, at most `seconds`; whether one came, now or earlier.
  bool wait(double seconds) noexcept;

 private:
  sigset_t set_{};
  sigset_t before_{};
  bool came_ = false;
};

}  // namespace artus
