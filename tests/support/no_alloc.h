// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
namespace artus::test {
/// Counts heap allocations made by this thread while alive. Test-only.
class AllocationCounter {
 public:
  AllocationCounter() noexcept;
  ~AllocationCounter();
  AllocationCounter(const AllocationCounter&) = delete;
  AllocationCounter& operator=(const AllocationCounter&) = delete;
  [[nodiscard]] long count() const noexcept;
  static bool supported() noexcept;
};
}  // namespace artus::test
