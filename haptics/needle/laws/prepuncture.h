// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include "artus/detail/haptics/needle/laws/force_model.h"
#include "artus/detail/haptics/needle/laws/god_object.h"

namespace artus {

/// A second-order polynomial in the dimple's depth, fitted on bovine liver. Source
/// [Simone2002] by [Alamilla2020] eq. 2.1 (printed for mm; here SI).
struct SimoneOkamuraParams {
  double a1 = 48.0;    ///< N/m   (0.0480 N/mm)
  double a2 = 5200.0;  ///< N/m^2 (0.0052 N/mm^2)
};

/// mu d^n + lambda d v, fitted in vivo on a human abdomen. Source [Barbe2006] by [Alamilla2020]
/// eq. 2.2.
struct BarbeParams {
  double mu = 240;      ///< N/m^n
  double lambda = 1.5;  ///< N s/m^2
  double n = 1.3;       ///< -
};

/// The polynomial's shape, scaled so that a membrane reaches its own puncture force at this dimple.
struct MembraneParams {
  double dimple = 0.8e-3;  ///< m; assumed: thinner than the skin (1.8 mm) and the bursa (1-2 mm),
                           ///< whose geometry does not follow the needle
};

/// A membrane that gives way lets go of its force within a time, as a crack takes one to open to
/// the needle's width. So a loop that finds the puncture a period later renders nearly the same
/// force.
struct TearParams {
  double time = 3e-3;  ///< s, time constant; assumed: 0.7 mm at a crack's 0.2 m/s
};

struct PrepunctureParams {
  MembraneParams membrane;
  TearParams tear;
  SimoneOkamuraParams simone_okamura;
  BarbeParams barbe;
  GodObjectParams god_object;  ///< skin only; deeper membranes take the same spring axially
};

/// The force against insertion, >= 0 N, of a surface pushed in by `d` m at speed `v` m/s (inward),
/// by the law that `layer` selects. Zero for d <= 0.
[[nodiscard]] ARTUS_REALTIME double prepuncture_force(const PrepunctureParams& params,
                                                      const LayerHaptics& layer, double d,
                                                      double v) noexcept;

/// The membrane that still holds, NeedleTick::dimple and membrane, and what is left of one that
/// gave way. Whether it has popped is the contact state's business.
class Prepuncture {
 public:
  explicit Prepuncture(const PrepunctureParams& params = {}) noexcept : params_(params) {}
  ARTUS_REALTIME void reset(double depth) noexcept;
  ARTUS_REALTIME Wrench step(const NeedleTick& tick) noexcept;

  /// A membrane gives way at `depth`, m, after a dimple of `dimple` m. `force`: N of it that
  /// nothing else has taken over. It fades as a spring whose stiffness falls, so that a needle
  /// drawn back on the way gets no more than the membrane had taken.
  ARTUS_REALTIME void tear(double force, double dimple, double depth) noexcept;

 private:
  PrepunctureParams params_;
  double torn_ = 0;         // N
  double torn_dimple_ = 0;  // m
  double torn_at_ = 0;      // m, the surface before it was pushed in
};

}  // namespace artus
