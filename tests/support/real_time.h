// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <gtest/gtest.h>

#include "tests/support/no_alloc.h"
#include "tests/support/no_lock.h"

namespace artus::test {

/// Keeps a result alive for the compiler, so that what computes it is really run.
template <class T>
void use(const T& value) noexcept {
  asm volatile("" : : "g"(&value) : "memory");
}

/// Calls `run` once under the allocation and the lock counter and fails on either. Where a
/// sanitizer owns malloc and the locks the calls are made all the same. Prefer ARTUS_RUNS_REALTIME.
template <class Run>
void expect_real_time(const char* function, Run run) {
  long allocations = 0;
  long locks = 0;
  {
    const AllocationCounter allocation_counter;
    const LockCounter lock_counter;
    run();
    locks = lock_counter.count();
    allocations = allocation_counter.count();
  }
  // Without the hooks both counters stay at zero.
  EXPECT_EQ(allocations, 0) << function << " allocates";
  EXPECT_EQ(locks, 0) << function << " locks";
}

}  // namespace artus::test

/// Runs statements that call `function`, which is marked ARTUS_REALTIME, under the allocation and
/// lock counters: ARTUS_RUNS_REALTIME(Scene::region_at, use(scene.region_at(p))). The check
/// architecture.real_time finds each marked function in one of these.
#define ARTUS_RUNS_REALTIME(function, ...) \
  artus::test::expect_real_time(#function, [&] { __VA_ARGS__; })
