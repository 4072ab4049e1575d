// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/training/live_attempt.h"

#include <cmath>
#include <utility>

#include "artus/detail/session/record/needle_contrast.h"
#include "artus/detail/training/session_meter.h"

namespace artus {

LiveAttempt::LiveAttempt(std::shared_ptr<const Scene> scene, MeterOptions options, double rate)
    : period_(1 / rate),
      meter_(std::move(scene), std::move(options)),
      moments_(static_cast<std::size_t>(std::ceil(meter_.options().longest * rate)) + 1) {}

void LiveAttempt::on_tick(const HapticSnapshot& tick) noexcept {
  add_tick(meter_, tick, period_);
  const std::int64_t sample = tick.input.device.time_ns;
  const double time = static_cast<double>(tick.input.tick) * period_;
  const std::size_t n = n_moments_.load(std::memory_order_relaxed);
  if (n == moments_.size()) full_.store(true, std::memory_order_relaxed);
  if (n < moments_.size() && (n == 0 || sample > moments_[n - 1].sample_ns)) {
    moments_[n] = {sample, time};
    n_moments_.store(n + 1, std::memory_order_release);
  }
  last_.store(time, std::memory_order_relaxed);
}

void LiveAttempt::on_frame(const FrameInput& input, const Frame& frame) {
  std::optional<ImageSight> sight;
  if (input.has_needle != 0)
    sight = sight_of(needle_contrast(input, frame, meter_.options().transducer));
  if (sight) shown_.store(sight->contrast_db.value_or(kNotShown), std::memory_order_relaxed);
  waiting_.push_back({input.sample_time_ns, sight, input.controls.motion != MotionShown::none});
  place_sights(false);
}

/// Gives pictures their tick's time as far as it is known; `over`: what is left gets the last one.
void LiveAttempt::place_sights(bool over) {
  const std::size_t n = n_moments_.load(std::memory_order_acquire);
  std::size_t placed = 0;
  for (Waiting& picture : waiting_) {
    while (at_ < n && moments_[at_].sample_ns < picture.sample_ns) ++at_;
    if (at_ == n && !over) break;
    ++placed;
    const double time = at_ < n ? moments_[at_].time : last_.load();
    if (picture.coloured) meter_.add_coloured(time);
    if (!picture.sight) continue;
    picture.sight->time = time;
    meter_.add_sight(*picture.sight);
  }
  waiting_.erase(waiting_.begin(), waiting_.begin() + static_cast<std::ptrdiff_t>(placed));
}

std::optional<double> LiveAttempt::shown_db() const noexcept {
  const double shown = shown_.load(std::memory_order_relaxed);
  return std::isnan(shown) ? std::nullopt : std::optional(shown);
}

AttemptMeasures LiveAttempt::measure() {
  place_sights(true);
  return meter_.measure();
}

}  // namespace artus
