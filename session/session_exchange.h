// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <atomic>

#include "artus/detail/core/check.h"

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

}  // namespace artus
