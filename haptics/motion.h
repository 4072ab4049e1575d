// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "haptics/force_model.h"

namespace artus {

struct MotionParams {
  double band = 0.155e-3;       ///< m, full width in which a still needle stays; assumed: above the
                                ///< tremor of a supported hand, no whole number of encoder steps
  double wake_band = 0.155e-3;  ///< m off its rest before a still needle moves; assumed: the same
  double settling_band = 0.6e-3;  ///< m, instead of the wake band for the settling time after a
                                  ///< stop; assumed: a hand follows the force that fades
  double settling_time = 0.25;    ///< s; assumed: the tracking wall's settling time and a margin
  double time = 0.075;  ///< s; the needle is still after this time within the band: eps = 2 mm/s
};

/// Says whether the needle moves and which way from positions alone: it is still when all of its
/// last positions over a time lie within a band, and moves again when it leaves that rest. The
/// source's |dx/dt| < eps, in a form that neither the loop's rate nor an encoder's step changes:
/// the range over a time is a continuous function of the path, so paths that differ by micrometres
/// come to rest at nearly the same time. Requires: dt below MotionParams::time.
class MotionDetector {
 public:
  explicit MotionDetector(const MotionParams& params = {}) noexcept : params_(params) {}

  ARTUS_REALTIME void reset(double x, Motion motion) noexcept {
    motion_ = motion;
    rest_ = x;
    settling_ = 0;
    start_window(x);
  }

  ARTUS_REALTIME Motion step(double x, double dt) noexcept {
    if (motion_ == Motion::still) {
      if (settling_ > 0) {
        settling_ -= dt;
        if (std::abs(x - rest_) <= params_.settling_band) {
          if (settling_ <= 0) rest_ = x;
          return motion_;
        }
      }
      if (std::abs(x - rest_) <= params_.wake_band) return motion_;
      motion_ = x > rest_ ? Motion::inward : Motion::outward;
      start_window(x);
      return motion_;
    }
    extreme_ = motion_ == Motion::inward ? std::max(extreme_, x) : std::min(extreme_, x);
    if (std::abs(x - extreme_) > params_.band) {
      motion_ = x > extreme_ ? Motion::inward : Motion::outward;
      extreme_ = x;
    }
    add(x, dt);
    if (filled_ == kBuckets) {
      const auto [low, high] = range(kBuckets);
      if (high - low <= params_.band) {
        motion_ = Motion::still;
        settling_ = params_.settling_time;
        const auto [last_low, last_high] =
            range(kBuckets / 2);  // a needle slows down into its rest
        rest_ = 0.5 * (last_low + last_high);
      }
    }
    return motion_;
  }

  [[nodiscard]] Motion motion() const noexcept { return motion_; }

 private:
  // The window is kept as the range of each of a number of equal stretches of time.
  static constexpr std::size_t kBuckets = 64;

  void start_window(double x) noexcept {
    extreme_ = x;
    elapsed_ = 0;
    filled_ = 1;
    low_.fill(x);
    high_.fill(x);
  }

  void add(double x, double dt) noexcept {
    const double bucket = params_.time / static_cast<double>(kBuckets - 1);
    elapsed_ += dt;
    while (elapsed_ >= bucket) {
      now_ = (now_ + 1) % kBuckets;
      low_[now_] = x;
      high_[now_] = x;
      filled_ = std::min(filled_ + 1, kBuckets);
      elapsed_ -= bucket;
    }
    low_[now_] = std::min(low_[now_], x);
    high_[now_] = std::max(high_[now_], x);
  }

  /// Least and greatest position of the newest `count` buckets.
  [[nodiscard]] std::pair<double, double> range(std::size_t count) const noexcept {
    double low = low_[now_];
    double high = high_[now_];
    for (std::size_t i = 1; i < count; ++i) {
      low = std::min(low, low_[(now_ - i) % kBuckets]);
      high = std::max(high, high_[(now_ - i) % kBuckets]);
    }
    return {low, high};
  }

  MotionParams params_;
  Motion motion_ = Motion::still;
  double rest_ = 0;
  double settling_ = 0;  // s left of the settling time
  double extreme_ = 0;   // the farthest position in the present direction
  std::array<double, kBuckets> low_{};
  std::array<double, kBuckets> high_{};
  double elapsed_ = 0;  // s in the present bucket
  std::size_t now_ = 0;
  std::size_t filled_ = 1;
};

/// The last values over a window of time, for differences: value now minus value a window ago. The
/// window is a time, so the lag (half of it) does not change with the loop's rate. Holds up to
/// kCapacity samples; the window is shortened when the rate is too high for it.
template <class T>
class SampleWindow {
 public:
  static constexpr std::size_t kCapacity = 256;

  /// Requires: window > 0, dt > 0.
  SampleWindow(double window, double dt) noexcept {
    const double n = std::round(window / dt);
    span_ = n < 1                                    ? 1
            : n > static_cast<double>(kCapacity) - 1 ? kCapacity - 1
                                                     : static_cast<std::size_t>(n);
  }

  ARTUS_REALTIME void reset(const T& value) noexcept {
    values_.fill(value);
    next_ = 0;
  }

  /// Stores the newest value and returns the one a window before it.
  ARTUS_REALTIME T push(const T& value) noexcept {
    T oldest = values_[(next_ + kCapacity - span_) % kCapacity];
    values_[next_] = value;
    next_ = (next_ + 1) % kCapacity;
    return oldest;
  }

  [[nodiscard]] double duration(double dt) const noexcept {
    return static_cast<double>(span_) * dt;
  }

 private:
  std::array<T, kCapacity> values_{};
  std::size_t next_ = 0;
  std::size_t span_ = 1;
};

}  // namespace artus
