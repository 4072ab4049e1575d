// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <cstddef>
#include <vector>

#include "artus/detail/core/check.h"
#include "artus/detail/haptics/actuator/pneumatic_params.h"

namespace artus {

/// The servovalve's flow sampled over opening and chamber pressure, and its inverse: what a control
/// law uses instead of the valve itself. It stands for the measured map of [Alamilla2020]
/// fig. 3-9, which is not printed. Openings are closest together at the centre; values between
/// samples are bilinear. Pressures beyond the sampled range use its ends.
class ValveMap {
 public:
  /// Samples the valve. Cost: about 39 k flows, once.
  ValveMap(const ServovalveParams& valve, const CylinderParams& cylinder);

  /// Flow into a chamber, kg/s.
  [[nodiscard]] ARTUS_REALTIME double flow(double opening, double p) const noexcept;

  /// The opening of one valve that lets `q` kg/s into a chamber at `p`; +-1 when it cannot.
  [[nodiscard]] ARTUS_REALTIME double find_opening(double q, double p) const noexcept;

  /// The active flow that one valve gives at an opening, kg/s. Source [Alamilla2020] (3.42).
  [[nodiscard]] ARTUS_REALTIME double active_flow(double opening, double p_P, double p_N,
                                                  double y) const noexcept;

  /// The opening at which one valve gives the active flow `q_A`: the inverse of (3.42); +-1 when
  /// it cannot. Requires: y inside the stroke.
  [[nodiscard]] ARTUS_REALTIME double find_active_opening(double q_A, double p_P, double p_N,
                                                          double y) const noexcept;

 private:
  static constexpr std::size_t kOpenings = 161;
  static constexpr std::size_t kPressures = 241;

  /// Where a pressure lies between two sampled ones.
  struct PressureBracket {
    std::size_t index = 0;
    double weight = 0;  ///< of index + 1
  };
  [[nodiscard]] PressureBracket bracket(double p) const noexcept;
  [[nodiscard]] double at(std::size_t i, const PressureBracket& b) const noexcept;
  /// The opening where a rising function of the sample index reaches `q`.
  template <class F>
  [[nodiscard]] double invert(double q, F value_at) const noexcept;
  template <class F>
  [[nodiscard]] double interpolate(double opening, F value_at) const noexcept;

  double stroke_;
  double step_;     // Pa
  double low_ = 0;  // Pa
  std::array<double, kOpenings> openings_{};
  std::vector<double> flows_;  // (kOpenings, kPressures), pressure fastest, kg/s
};

}  // namespace artus
