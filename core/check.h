// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cassert>
#include <stdexcept>
#include <string>

/// The caller broke a documented "Requires": throws std::invalid_argument at the public border.
/// Never used in real-time code, which reports a status and renders zero force instead.
#define ARTUS_REQUIRE(condition, message)                                                    \
  do {                                                                                       \
    if (!(condition)) throw std::invalid_argument(std::string(__func__) + ": " + (message)); \
  } while (false)

/// We broke our own invariant: aborts in the dev and sanitizer builds, costs nothing in release.
#ifdef ARTUS_ENABLE_ASSERTS
#define ARTUS_ASSERT(condition) assert(condition)
#else
#define ARTUS_ASSERT(condition) static_cast<void>(0)
#endif

/// Marks a function of the haptic or imaging tick: it never allocates, locks, logs, does I/O or
/// throws. The realtime tests call every marked function under a counting allocator.
#define ARTUS_REALTIME
