// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <atomic>
#include <mutex>
#include <string>
#include <vector>

#include "options.h"

namespace artus::bridge {

/// Round trips of one second and more in steps of 10 us, and what was lost.
class Statistics {
 public:
  void add_round_trip(std::uint64_t ns) noexcept;
  /// us below which the share of round trips lies.
  [[nodiscard]] double percentile(double share) const noexcept;
  [[nodiscard]] std::uint64_t round_trips() const noexcept { return count_; }

 private:
  static constexpr std::uint64_t kStep = 10'000;  // ns
  std::array<std::uint32_t, 10'000> bins_{};
  std::uint64_t count_ = 0;
};

/// Both hands of one program on one link: whichever device ticks writes POS with the newest pose of
/// both, and reads FORCE for itself. A hand whose device is silent for 15 ms is not present.
class Bridge {
 public:
  /// `link`: open, outlives the bridge.
  Bridge(artus_shm_link& link, const Options& options);

  /// A tick of the device of that number, from the device's own thread.
  Triple tick(std::size_t device, const Reading& reading);
  /// The device is gone: its hand is not present from now on.
  void lose(std::size_t device);
  [[nodiscard]] std::string statistics() const;

 private:
  struct Side {
    Hand hand;
    artus_shm_pos part{};        // what the hand last wrote of itself
    std::uint64_t heard_ns = 0;  // 0: not present
    std::uint64_t ticks = 0;
    std::uint64_t resting = 0;      // ticks without a force, for whatever reason
    std::uint64_t exchange_ns = 0;  // since when the clutch is held
    bool clutch = false;
  };
  void write(std::uint64_t now_ns);
  void exchange_hands(std::uint64_t now_ns);

  artus_shm_link& link_;
  mutable std::mutex mutex_;  // held for some microseconds
  std::vector<Side> sides_;
  artus_shm_force felt_{};
  std::uint64_t sample_ = 0;
  std::uint64_t answered_ = 0;  // sample of the last round trip
  bool exchanged_ = false;      // the two clutches have not been let go since
  Statistics statistics_;
};

}  // namespace artus::bridge
