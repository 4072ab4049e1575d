// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "artus/detail/haptics/needle/laws/force_model.h"

namespace artus {

struct MotionParams {
  double band = 0.155e-3;        ///< m, range in which a needle is wholly still; assumed: above the
                                 ///< tremor of a supported hand, no whole number of encoder steps
  double moving_band = 0.31e-3;  ///< m, range from which on it wholly moves; assumed: twice that
  double time = 0.11;  ///< s over which the range is taken: eps = 1.4 to 2.8 mm/s; assumed
};

/// Says how still the needle is and which direction it moves in, from positions alone: by the range
/// of all of its last positions over a time. The source's |dx/dt| < eps, in a form that neither the
/// loop's rate nor an encoder's step changes, and with a band instead of an edge: stillness is a
/// continuous function of the path, so paths that differ by micrometres come to rest nearly alike,
/// where an edge would let one rest and the other not. Requires: dt below MotionParams::time.
class MotionDetector {
 public:
  explicit MotionDetector(const MotionParams& params = {}) noexcept : params_(params) {}

  ARTUS_REALTIME void reset(double x, Motion motion) noexcept {
    if (motion != Motion::still) direction_ = motion;
    extreme_ = x;
    elapsed_ = 0;
    filled_ = motion == Motion::still ? kBuckets : 1;
    low_.fill(x);
    high_.fill(x);
    stillness_ = motion == Motion::still ? 1 : 0;
  }

  ARTUS_REALTIME void step(double x, double dt) noexcept {
    extreme_ = direction_ == Motion::inward ? std::max(extreme_, x) : std::min(extreme_, x);
    if (std::abs(x - extreme_) > params_.band) {
      direction_ = x > extreme_ ? Motion::inward : Motion::outward;
      extreme_ = x;
    }
    add(x, dt);
    stillness_ = 0;
    if (filled_ < kBuckets) return;
    const auto low = *std::min_element(low_.begin(), low_.end());
    const auto high = *std::max_element(high_.begin(), high_.end());
    stillness_ = std::clamp(
        (params_.moving_band - (high - low)) / (params_.moving_band - params_.band), 0.0, 1.0);
  }

  /// Positions are counted from another origin from now on: all, past ones too, are `by` m more.
  ARTUS_REALTIME void shift(double by) noexcept {
    extreme_ += by;
    for (double& x : low_) x += by;
    for (double& x : high_) x += by;
  }

  /// 1 at rest, 0 on the move.
  [[nodiscard]] double stillness() const noexcept { return stillness_; }
  [[nodiscard]] Motion motion() const noexcept {
    return stillness_ > kHalf ? Motion::still : direction_;
  }

 private:
  // The window is kept as the range of each of a number of equal stretches of time.
  static constexpr std::size_t kBuckets = 64;
  static constexpr double kHalf = 0.5;

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

  MotionParams params_;
  Motion direction_ = Motion::inward;
  double stillness_ = 1;
  double extreme_ = 0;  // the farthest position in the present direction
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
    if constexpr (requires { T::Zero(); }) values_.fill(T::Zero());  // {} leaves Eigen's unset
    span_ = n < 1                                    ? 1
            : n > static_cast<double>(kCapacity) - 1 ? kCapacity - 1
                                                     : static_cast<std::size_t>(n);
  }

  ARTUS_REALTIME void reset(const T& value) noexcept {
    values_.fill(value);
    next_ = 0;
  }

  /// Adds `by` to every value of the past.
  ARTUS_REALTIME void shift(const T& by) noexcept {
    for (T& value : values_) value += by;
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
