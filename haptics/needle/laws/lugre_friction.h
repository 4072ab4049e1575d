// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <limits>

#include "artus/detail/haptics/needle/laws/force_model.h"
#include "artus/detail/haptics/needle/laws/motion.h"

namespace artus {

/// One published parameter set. mu_s < mu_c (stiction below Coulomb) is as published. The source
/// states no units; they are millimetres and seconds: with metres the bristle would have to bend by
/// half a metre before the needle slides. Here SI.
struct LugreParams {
  double sigma0 = 2.469e3;  ///< 1/m   (2.469 1/mm)
  double sigma1 = 0.845e3;  ///< s/m   (0.845 s/mm)
  double sigma2 = 2.76e-1;  ///< s/m   (2.76e-4 s/mm)
  double mu_c = 1.386;      ///< -
  double mu_s = 0.084;      ///< -
  double alpha = 0.079e3;   ///< s/m   (0.079 s/mm)
  double length = 0.040;    ///< m, shaft length the set was identified with; F_n grows with it
  double stiffness_limit = 1000;  ///< N/m on F_n sigma0; assumed: published, a shaft deep in tissue
                                  ///< is as stiff as bone (4 kN/m), and each step of a device's
                                  ///< encoder a knock; of the order of the tissues' own K_t
  double damping_limit = 2;       ///< N s/m on F_n sigma1; assumed: the published value is above 1
                                  ///< kN s/m, which no sampled device can render
  double relaxation_time = 0.03;  ///< s in which the bristle gives way to the level g(v) of a
                                  ///< needle that slows down, |z| <= g / sigma0; assumed
};

/// The four sets, needle 20 mm at 0.025 and 0.05 Hz, 40 mm at 0.025 (the source's choice, default
/// above) and 0.05 Hz. Source [Asadian2011] by [Alamilla2020] table 2.1.
[[nodiscard]] const std::array<LugreParams, 4>& lugre_sets() noexcept;

/// g(v) = mu_c + (mu_s - mu_c) exp(-alpha |v|), eq. 2.5.
[[nodiscard]] ARTUS_REALTIME double lugre_level(const LugreParams& params, double v) noexcept;

/// The bristle's state and force coefficient, for one contact. f / F_n = sigma0 z + sigma1 dz/dt +
/// sigma2 v (2.4-2.6). What is kept is the load sigma0 z, so that the force stays when sigma0
/// changes. It is advanced by the exact solution for constant speed, so that |z| <= max(g) / sigma0
/// holds for any step.
class LugreBristle {
 public:
  /// Over dt, lets go of what the load has above g(v), which falls when the needle slows down.
  ARTUS_REALTIME void relax(const LugreParams& params, double v, double dt) noexcept;
  /// Advances over `moved` m towards the level `level`, > 0, of F_n. Returns sigma0 z.
  ARTUS_REALTIME double advance(const LugreParams& params, double moved, double level) noexcept;
  /// Advances over `moved` m in `dt` s with `v` for the level g; returns f / F_n, in the direction
  /// of motion (the hand feels its opposite). `sigma1` replaces the set's when smaller.
  ARTUS_REALTIME double step(const LugreParams& params, double moved, double v, double dt,
                             double sigma1) noexcept;
  ARTUS_REALTIME void reset() noexcept { load_ = 0; }
  /// z, m
  [[nodiscard]] double load() const noexcept { return load_; }  ///< sigma0 z, of F_n
  [[nodiscard]] double deflection(const LugreParams& params) const noexcept {
    return load_ / params.sigma0;
  }

 private:
  double load_ = 0;
};

/// Friction along the shaft: F_n is the sum over the layers of f_R * friction scale * shaft length
/// in the layer / set's length. (The source's F_n is the cutting force itself, which would make
/// friction vanish on withdrawal.) The steady force is the published one; the bristle is no stiffer
/// than stiffness_limit, so that neither an encoder's step nor the loop's rate is felt; what a
/// needle that slows down holds above g(v) goes with time (relax), as over distance it would go at
/// z sigma0 / g times that stiffness. dz/dt is a difference over a fixed time: over the loop's own
/// period an encoder's step would be a knock that grows with the rate.
class LugreFriction {
 public:
  static constexpr double kRateWindow = 8e-3;  ///< s; assumed: some steps of a coarse encoder
  /// Requires: dt > 0 s, the fixed period of the loop.
  explicit LugreFriction(double dt, const LugreParams& params = {}) noexcept
      : params_(params), deflections_(kRateWindow, dt), depths_(kRateWindow, dt) {}
  ARTUS_REALTIME void reset(double depth) noexcept;
  ARTUS_REALTIME Wrench step(const NeedleTick& tick) noexcept;
  /// The line is taken anew: depths are `by` m more, the bristles stay bent.
  ARTUS_REALTIME void take_line(double by) noexcept;

 private:
  LugreParams params_;
  LugreBristle bristle_;
  SampleWindow<double> deflections_;
  SampleWindow<double> depths_;
  double last_x_ = 0;
};

}  // namespace artus
