// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <cmath>
#include <cstddef>

#include "haptics/force_model.h"

namespace artus {

struct MotionParams {
  double band = 0.1e-3;  ///< m; assumed: above an encoder step (0.055 mm, Touch) and physiological
                         ///< tremor of a supported hand
  double wake_band = 0.15e-3;  ///< m off its rest before a still needle moves; assumed: tremor's
                               ///< peak to peak
  double time = 0.05;  ///< s; the needle is still after this time within the band: eps = 2 mm/s
};

/// Says whether the needle moves and which way from positions alone: it moves when it leaves a band
/// round its last rest, it is still when it stays there for a time. The source's |dx/dt| < eps, in
/// a form that neither the loop's rate nor an encoder's step changes.
class MotionDetector {
 public:
  explicit MotionDetector(const MotionParams& params = {}) noexcept : params_(params) {}

  ARTUS_REALTIME void reset(double x, Motion motion) noexcept {
    reference_ = std::round(x / params_.band) * params_.band;
    quiet_ = 0;
    motion_ = motion;
  }

  ARTUS_REALTIME Motion step(double x, double dt) noexcept {
    const double band = motion_ == Motion::still ? params_.wake_band : params_.band;
    if (std::abs(x - reference_) > band) {
      motion_ = x > reference_ ? Motion::inward : Motion::outward;
      // To the last line of a fixed grid that was crossed: where the samples fell does not matter.
      reference_ += std::trunc((x - reference_) / params_.band) * params_.band;
      quiet_ = 0;
      return motion_;
    }
    quiet_ += dt;
    if (quiet_ >= params_.time && motion_ != Motion::still) {
      motion_ = Motion::still;
      reference_ = x;
    }
    return motion_;
  }

  [[nodiscard]] Motion motion() const noexcept { return motion_; }

 private:
  MotionParams params_;
  double reference_ = 0;
  double quiet_ = 0;
  Motion motion_ = Motion::still;
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
    const T oldest = values_[(next_ + kCapacity - span_) % kCapacity];
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
