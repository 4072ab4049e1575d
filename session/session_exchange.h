// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <type_traits>
#include <vector>

#include "artus/core/check.h"

namespace artus {

/// The newest of a row of large values (images): one producer fills a slot of its own and swaps it
/// in, one consumer swaps the newest out. Three slots, so neither ever waits; what nobody fetched
/// is overwritten.
template <class T>
class NewestMailbox {
 public:
  /// The slot to fill; belongs to the producer until publish().
  [[nodiscard]] T& slot() noexcept { return slots_[back_]; }
  ARTUS_REALTIME void publish() noexcept {
    back_ = middle_.exchange(back_ | kFresh, std::memory_order_acq_rel) & kIndex;
  }
  /// The newest value; null before the first. The same as last time when there is no newer one.
  [[nodiscard]] const T* newest() noexcept {
    if ((middle_.load(std::memory_order_relaxed) & kFresh) != 0) {
      front_ = middle_.exchange(front_, std::memory_order_acq_rel) & kIndex;
      filled_ = true;
    }
    return filled_ ? &slots_[front_] : nullptr;
  }

 private:
  static constexpr unsigned kFresh = 4;
  static constexpr unsigned kIndex = 3;
  std::array<T, 3> slots_{};
  std::atomic<unsigned> middle_{1};
  unsigned back_ = 0;
  unsigned front_ = 2;
  bool filled_ = false;
};

/// A row of plain values from one thread to another. A full ring drops the value and counts it: the
/// producer never waits.
template <class T>
class SpscRing {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  explicit SpscRing(std::size_t capacity) : values_(capacity + 1) {}

  /// False when it was dropped.
  ARTUS_REALTIME bool push(const T& value) noexcept {
    const std::size_t at = head_.load(std::memory_order_relaxed);
    const std::size_t next = at + 1 == values_.size() ? 0 : at + 1;
    if (next == tail_.load(std::memory_order_acquire)) {
      dropped_.store(dropped_.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
      return false;
    }
    values_[at] = value;
    head_.store(next, std::memory_order_release);
    return true;
  }
  /// False when there is none.
  [[nodiscard]] ARTUS_REALTIME bool pop(T& value) noexcept {
    const std::size_t at = tail_.load(std::memory_order_relaxed);
    if (at == head_.load(std::memory_order_acquire)) return false;
    value = values_[at];
    tail_.store(at + 1 == values_.size() ? 0 : at + 1, std::memory_order_release);
    return true;
  }
  [[nodiscard]] std::uint64_t dropped() const noexcept {
    return dropped_.load(std::memory_order_relaxed);
  }

 private:
  std::vector<T> values_;
  std::atomic<std::size_t> head_{0};
  std::atomic<std::size_t> tail_{0};
  std::atomic<std::uint64_t> dropped_{0};
};

}  // namespace artus
