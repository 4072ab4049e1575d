// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
namespace artus::test {
/// Counts the locks that this thread takes or waits for while alive: mutexes, reader-writer locks,
/// condition variables and semaphores of the C library, on which those of C++, Embree and TBB are
/// built. Test-only.
class LockCounter {
 public:
  LockCounter() noexcept;
  ~LockCounter();
  LockCounter(const LockCounter&) = delete;
  LockCounter& operator=(const LockCounter&) = delete;
  [[nodiscard]] long count() const noexcept;
  static bool supported() noexcept;
};
}  // namespace artus::test
