// SPDX-License-Identifier: AGPL-3.0-or-later
#include "bridge.h"

#include <algorithm>
#include <cstdio>

namespace artus::bridge {
namespace {

constexpr std::uint64_t kSilent = 15'000'000;  // ns after which a hand, or artus, is not there
constexpr std::uint64_t kExchange =
    1'000'000'000;  // ns that both clutches are held to exchange hands

}  // namespace

void Statistics::add_round_trip(std::uint64_t ns) noexcept {
  ++bins_[std::min<std::uint64_t>(ns / kStep, bins_.size() - 1)];
  ++count_;
}

double Statistics::percentile(double share) const noexcept {
  const auto wanted = static_cast<std::uint64_t>(share * static_cast<double>(count_));
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < bins_.size(); ++i) {
    sum += bins_[i];
    if (sum >= wanted && sum > 0)
      return 1e-3 * static_cast<double>(kStep) * static_cast<double>(i + 1);
  }
  return 0;
}

Bridge::Bridge(artus_shm_link& link, const Options& options) : link_(link) {
  for (const ChosenDevice& device : options.devices) {
    HandSetup setup = options.setup;
    setup.probe = device.probe;
    sides_.push_back({Hand(setup), {}, 0, 0, 0, 0, false});
  }
}

void Bridge::exchange_hands(std::uint64_t now_ns) {
  if (sides_.size() != 2) return;
  const bool both = std::all_of(sides_.begin(), sides_.end(), [&](const Side& side) {
    return side.clutch && now_ns - side.exchange_ns > kExchange;
  });
  if (both && !exchanged_)
    for (Side& side : sides_) {
      side.hand.become(!side.hand.setup().probe);
      side.heard_ns = 0;
    }
  exchanged_ = both || (exchanged_ && (sides_[0].clutch || sides_[1].clutch));
}

void Bridge::write(std::uint64_t now_ns) {
  artus_shm_pos pos = artus_shm_pos_init();
  for (const Side& side : sides_) {
    if (side.heard_ns == 0 || now_ns - side.heard_ns > kSilent) continue;
    const bool probe = side.hand.setup().probe;
    std::copy_n(probe ? side.part.probe_position : side.part.needle_position, 3,
                probe ? pos.probe_position : pos.needle_position);
    std::copy_n(probe ? side.part.probe_rotation : side.part.needle_rotation, 4,
                probe ? pos.probe_rotation : pos.needle_rotation);
    pos.present |= probe ? 2U : 1U;
    pos.buttons |= side.part.buttons;
  }
  pos.sample = ++sample_;
  pos.time_ns = now_ns;
  artus_shm_write_pos(&link_, &pos);
}

Triple Bridge::tick(std::size_t device, const Reading& reading) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const std::uint64_t now = artus_shm_now_ns();
  Side& side = sides_[device];
  ++side.ticks;
  artus_shm_pos part = artus_shm_pos_init();
  const bool there = side.hand.pose(reading, felt_, now, part);
  const bool clutch = there && (reading.buttons & side.hand.setup().clutch) != 0;
  if (clutch && !side.clutch) side.exchange_ns = now;
  side.clutch = clutch;
  side.part = part;
  side.heard_ns = there ? now : 0;
  exchange_hands(now);
  write(now);
  const bool read = artus_shm_read_force(&link_, &felt_) == 1;
  const std::uint64_t after = artus_shm_now_ns();
  const auto age = static_cast<std::int64_t>(after - felt_.time_ns);
  const bool fresh = read && age < static_cast<std::int64_t>(kSilent);
  if (fresh && felt_.pos_sample > answered_ && felt_.pos_sample <= sample_) {
    answered_ = felt_.pos_sample;
    statistics_.add_round_trip(after - felt_.pos_time_ns);
  }
  const Triple force = side.hand.force(felt_, fresh, after);
  if (side.hand.rest() != Rest::none) ++side.resting;
  return force;
}

void Bridge::lose(std::size_t device) {
  const std::lock_guard<std::mutex> lock(mutex_);
  sides_[device].heard_ns = 0;
  sides_[device].clutch = false;
  sides_[device].hand.forget();
  write(artus_shm_now_ns());
}

std::string Bridge::statistics() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  std::string text = "{\"round_trips\": " + std::to_string(statistics_.round_trips());
  char numbers[128];
  std::snprintf(numbers, sizeof numbers, ", \"p50_us\": %.0f, \"p99_us\": %.0f, \"most_us\": %.0f",
                statistics_.percentile(0.5), statistics_.percentile(0.99),
                statistics_.percentile(1));
  text += numbers;
  text += ", \"devices\": [";
  for (const Side& side : sides_)
    text += std::string(&side == sides_.data() ? "" : ", ") +
            "{\"ticks\": " + std::to_string(side.ticks) +
            ", \"resting\": " + std::to_string(side.resting) + "}";
  return text + "]}";
}

}  // namespace artus::bridge
