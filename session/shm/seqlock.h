// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include "artus/detail/core/check.h"

namespace artus {

/// The newest value of one writer, for any number of readers, without locks: the writer never
/// waits, a reader tries again when a write came in between. The value lives in 64-bit atomic words
/// and the sequence is odd while they change, so there is no data race by the language's rules and
/// the same object may live in memory shared with another process. Layout: sequence, then the value
/// padded to whole words. Source [Boehm2012] section 4, with acquire and release words in place of
/// fences.
template <class T>
class Seqlock {
  static_assert(std::is_trivially_copyable_v<T>, "a torn copy is made and thrown away");
  static_assert(std::atomic<std::uint64_t>::is_always_lock_free);

 public:
  static constexpr std::size_t kWords = (sizeof(T) + 7) / 8;

  /// Publishes `value`. One writer at a time. A sequence left odd by a writer that died is taken
  /// up.
  ARTUS_REALTIME void store(const T& value) noexcept { store_prefix(value, sizeof(T)); }

  /// The same for the first `size` bytes only; the rest keeps what it had.
  /// Requires: size <= sizeof(T).
  ARTUS_REALTIME void store_prefix(const T& value, std::size_t size) noexcept {
    const std::uint64_t odd = sequence_.load(std::memory_order_relaxed) | 1U;
    sequence_.store(odd, std::memory_order_relaxed);
    const auto* bytes = reinterpret_cast<const unsigned char*>(&value);
    const std::size_t n = size < sizeof(T) ? size : sizeof(T);
    for (std::size_t i = 0; 8 * i < n; ++i) {
      std::uint64_t word = 0;
      std::memcpy(&word, bytes + 8 * i, sizeof(T) - 8 * i < 8 ? sizeof(T) - 8 * i : 8);
      words_[i].store(word, std::memory_order_release);
    }
    sequence_.store(odd + 1, std::memory_order_release);
  }

  /// One try: false when a write was going on, and then what `out` holds means nothing.
  [[nodiscard]] ARTUS_REALTIME bool try_load(T& out) const noexcept {
    const std::uint64_t before = sequence_.load(std::memory_order_acquire);
    if ((before & 1U) != 0) return false;
    auto* bytes = reinterpret_cast<unsigned char*>(&out);
    for (std::size_t i = 0; i < kWords; ++i) {
      const std::uint64_t word = words_[i].load(std::memory_order_acquire);
      std::memcpy(bytes + 8 * i, &word, sizeof(T) - 8 * i < 8 ? sizeof(T) - 8 * i : 8);
    }
    return sequence_.load(std::memory_order_relaxed) == before;
  }

  /// Up to `tries` tries; a bounded wait even when the writer died in the middle of a write.
  [[nodiscard]] ARTUS_REALTIME bool load(T& out, int tries = 64) const noexcept {
    for (int i = 0; i < tries; ++i) {
      if (try_load(out)) return true;
    }
    return false;
  }

  /// Twice the number of values published since the memory was zeroed; odd during a write.
  [[nodiscard]] ARTUS_REALTIME std::uint64_t sequence() const noexcept {
    return sequence_.load(std::memory_order_acquire);
  }

 private:
  std::atomic<std::uint64_t> sequence_{0};
  std::array<std::atomic<std::uint64_t>, kWords> words_{};
};

}  // namespace artus
