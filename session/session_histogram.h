// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cstdint>

#include "artus/detail/core/check.h"

namespace artus {

/// How long things took, without a lock: one thread adds, any thread reads. Bins grow with the
/// value (32 per factor of two, so a percentile is right within 3 %), from 1 ns to 36 minutes. A
/// late tick counts also for those that it made wait (coordinated omission): see add_with_missed.
class LatencyHistogram {
 public:
  static constexpr int kPerOctave = 32;
  static constexpr int kBins = 37 * kPerOctave;

  ARTUS_REALTIME void add(std::int64_t ns) noexcept {
    const std::uint64_t value = ns > 0 ? static_cast<std::uint64_t>(ns) : 0;
    std::atomic<std::uint32_t>& bin = bins_[index_of(value)];
    bin.store(bin.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
    count_.store(count_.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
    if (value > max_.load(std::memory_order_relaxed)) max_.store(value, std::memory_order_relaxed);
  }

  /// Adds `ns` and, for every whole `period` it is longer than one, what a tick due then would have
  /// seen. Requires: period > 0.
  ARTUS_REALTIME void add_with_missed(std::int64_t ns, std::int64_t period) noexcept {
    add(ns);
    for (std::int64_t missed = ns - period; missed >= period; missed -= period) add(missed);
  }

  [[nodiscard]] std::uint64_t count() const noexcept {
    return count_.load(std::memory_order_relaxed);
  }
  [[nodiscard]] double max_us() const noexcept {
    return 1e-3 * static_cast<double>(max_.load(std::memory_order_relaxed));
  }
  /// The value that a share `q` of all stay below or at, us; 0 when empty.
  [[nodiscard]] double percentile_us(double q) const noexcept {
    const auto wanted = static_cast<std::uint64_t>(q * static_cast<double>(count()));
    std::uint64_t sum = 0;
    for (int i = 0; i < kBins; ++i) {
      sum += bins_[static_cast<std::size_t>(i)].load(std::memory_order_relaxed);
      if (sum > wanted) return std::min(1e-3 * upper_edge(i), max_us());
    }
    return max_us();
  }
  /// Number in bin `i`, and the bin's upper edge, ns.
  [[nodiscard]] std::uint32_t bin(int i) const noexcept {
    return bins_[static_cast<std::size_t>(i)].load(std::memory_order_relaxed);
  }
  [[nodiscard]] static double upper_edge(int i) noexcept {
    if (i < kPerOctave) return i + 1;
    const int octave = i / kPerOctave - 1;
    return static_cast<double>(static_cast<std::uint64_t>(kPerOctave + i % kPerOctave + 1)
                               << octave);
  }

 private:
  [[nodiscard]] static std::size_t index_of(std::uint64_t value) noexcept {
    if (value < kPerOctave) return value;
    const int octave = static_cast<int>(std::bit_width(value)) - 6;  // value >> octave: [32, 64)
    const auto index = static_cast<std::size_t>(octave * kPerOctave) + (value >> octave);
    return index < kBins ? index : kBins - 1;
  }

  std::array<std::atomic<std::uint32_t>, kBins> bins_{};
  std::atomic<std::uint64_t> count_{0};
  std::atomic<std::uint64_t> max_{0};
};

}  // namespace artus
