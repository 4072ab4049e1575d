// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

namespace artus {

/// From now on the last thing in every FORCE segment that this process writes is zero force and
/// "stopped", also when it ends by a crash: SIGSEGV, SIGABRT (std::terminate, a failed check),
/// SIGBUS, SIGFPE, SIGILL, SIGSYS, SIGQUIT, or by exit() with a session still running. The
/// signals then do what they did before. For programs, at their start, once; the library alone
/// changes no signal of fatal errors. SIGKILL cannot be helped: readers judge age by their own
/// clock.
void install_zero_force_on_crash();

}  // namespace artus
