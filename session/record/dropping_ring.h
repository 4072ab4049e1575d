// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include <boost/lockfree/spsc_queue.hpp>

#include "artus/detail/core/check.h"

namespace artus {

/// A row of plain values from one thread to another: boost::lockfree::spsc_queue, which neither
/// waits nor allocates after it is made, and a count of what a full one drops. Included by sources
/// only: Boost's headers are long.
template <class T>
class DroppingRing {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  explicit DroppingRing(std::size_t capacity) : queue_(capacity) {}

  /// False when it was dropped.
  ARTUS_REALTIME bool push(const T& value) noexcept {
    if (queue_.push(value)) return true;
    dropped_.store(dropped_.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
    return false;
  }
  /// False when there is none.
  [[nodiscard]] ARTUS_REALTIME bool pop(T& value) noexcept { return queue_.pop(value); }
  [[nodiscard]] std::uint64_t dropped() const noexcept {
    return dropped_.load(std::memory_order_relaxed);
  }

 private:
  boost::lockfree::spsc_queue<T> queue_;
  std::atomic<std::uint64_t> dropped_{0};
};

}  // namespace artus
