// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <atomic>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "artus/detail/training/metrics/attempt_meter.h"
#include "artus/session/session.h"

namespace artus {

/// Measures an attempt while its session runs: what the recording says afterwards, to the last
/// digit, as long as the recording lost nothing and the attempt is within the options' `longest`.
/// A picture counts at the first tick of the sample that it shows, as in `assess`. Memory: 16 bytes
/// a tick of `longest`, beside the meter's.
class LiveAttempt final : public SessionObserver {
 public:
  /// `rate`: Hz, of the ticks. Requires: a scene, valid options.
  LiveAttempt(std::shared_ptr<const Scene> scene, MeterOptions options, double rate);

  ARTUS_REALTIME void on_tick(const HapticSnapshot& tick) noexcept override;
  void on_frame(const FrameInput& input, const Frame& frame) override;

  /// Whether the session went on beyond `longest`, of which nothing is measured. Any thread.
  [[nodiscard]] bool full() const noexcept { return full_.load(std::memory_order_relaxed); }
  [[nodiscard]] double longest() const noexcept { return meter_.options().longest; }  ///< s

  /// dB by which the tip stood out in the last picture; empty: there was none of a needle. A tip of
  /// which nothing showed stands out by kNotShown. Any thread.
  [[nodiscard]] std::optional<double> shown_db() const noexcept;

  /// All numbers. Requires: the session is over. Cost: linear in ticks.
  [[nodiscard]] AttemptMeasures measure();

 private:
  /// The first tick of a sample of the device.
  struct Moment {
    std::int64_t sample_ns = 0;
    double time = 0;  ///< s
  };
  struct Waiting {
    std::int64_t sample_ns = 0;
    std::optional<ImageSight> sight;  ///< empty: no needle
    bool coloured = false;            ///< of Doppler
  };
  void place_sights(bool over);

  double period_;  // s
  AttemptMeter meter_;
  std::vector<Moment> moments_;  // below n_moments_ they do not change
  std::atomic<std::size_t> n_moments_{0};
  std::atomic<bool> full_{false};
  std::atomic<double> last_{0};  // s, of the last tick
  // dB, of the last picture; not a number: none
  std::atomic<double> shown_{std::numeric_limits<double>::quiet_NaN()};
  std::vector<Waiting> waiting_;  // the imaging thread's, until their tick is published
  std::size_t at_ = 0;            // moment of the last placed picture
};

}  // namespace artus
