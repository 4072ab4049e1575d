// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cmath>

#include "artus/detail/core/units.h"

namespace artus {

/// The values that a setting may take, both ends included; SI.
struct Range {
  double low = 0;
  double high = 0;
};

/// A range in another unit (as large as `unit` in SI), rounded to a millionth of it.
[[nodiscard]] inline Range in_unit(const Range& range, double unit) noexcept {
  const auto round = [unit](double value) {
    return std::round(value / unit * 1e6) / 1e6;
  };
  return {round(range.low), round(range.high)};
}

/// Of ImageSettings; validate() and the flags ask here.
struct ImageRanges {
  static constexpr Range depth{5e-3, 0.3};  // m
  static constexpr Range n_samples{16, 16384};
  static constexpr Range n_planes{1, 33};
  static constexpr Range dynamic_range_db{10, 150};
  static constexpr Range gain_db{-60, 100};
  static constexpr Range tgc_db_cm_mhz{0, 3};
  static constexpr Range tgc_limit_db{0, 200};
  static constexpr Range speckle_db{-150, 0};
  static constexpr Range noise_db{-300, 0};
  static constexpr Range gel_limit{0, 0.1};     // m
  static constexpr Range pixel{0.02e-3, 2e-3};  // m
  static constexpr Range persistence{0, 0.99};
  static constexpr Range smoothing{0, 1};
  static constexpr Range compound_angles{1, 9};
  static constexpr Range compound_spread{0, 0.7};  // rad
  static constexpr Range doppler_limit{1e-3, 10};  // m/s
  static constexpr Range look{0, 2};
  static constexpr Range grey{0, 1};
  static constexpr Range n_threads{0, 1024};
};

/// Of Transducer.
struct TransducerRanges {
  static constexpr Range width{1e-3, 0.2};                       // m
  static constexpr Range steering{-40 * kDegree, 40 * kDegree};  // rad
  static constexpr Range n_lines{1, 4096};
  static constexpr Range frequency{1e6, 50e6};  // Hz
  static constexpr Range bandwidth{0.05, 1.5};
  static constexpr Range pulse_cycles{0.5, 20};
  static constexpr Range f_number{0.5, 20};
  static constexpr Range max_aperture{0.5e-3, 0.2};       // m
  static constexpr Range elevation_height{0.5e-3, 0.05};  // m
  static constexpr Range elevation_focus{2e-3, 0.5};      // m
  static constexpr Range transmit_focus{2e-3, 0.5};       // m, unless 0
  static constexpr Range radius{5e-3, 0.2};               // m, unless 0
  static constexpr Range width_over_radius{0, 2.5};
};

/// What a scanner's knobs reach in a session on a joint; within the ranges above.
struct KnobRanges {
  static constexpr Range depth{20e-3, 80e-3};  // m
  static constexpr Range gain_db{-20, 30};
  static constexpr Range tgc_db_cm_mhz{0, 1.5};
  static constexpr Range dynamic_range_db{30, 90};
  static constexpr Range frequency{5e6, 18e6};          // Hz
  static constexpr Range elevation_focus{5e-3, 50e-3};  // m
  static constexpr Range persistence{0, 0.9};
};

}  // namespace artus
