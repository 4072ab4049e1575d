// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include "artus/detail/haptics/needle/laws/force_model.h"

namespace artus {

/// The direct method: a constant force against insertion while inside, none outside. Chatters at
/// the surface and ejects a released needle; kept for comparison. Source [Alamilla2020]
/// section 2.1.2.
class DirectCutting {
 public:
  ARTUS_REALTIME void reset(double depth) noexcept;
  ARTUS_REALTIME Wrench step(const NeedleTick& tick) noexcept;
};

/// A spring anchored at the surface: f = K (w0 - x). K is the layer's wall stiffness. Source
/// [Alamilla2020] eq. 2.7.
class SpringCutting {
 public:
  ARTUS_REALTIME void reset(double depth) noexcept;
  ARTUS_REALTIME Wrench step(const NeedleTick& tick) noexcept;
};

struct VoigtParams {
  double damping = 5;  ///< N s/m, B; assumed: a tenth of critical for 0.3 kg on 2000 N/m
};

/// Spring and damper: f = K (w0 - x) - B dx/dt inside, none outside. Source [Alamilla2020] eq. 2.8.
class VoigtCutting {
 public:
  explicit VoigtCutting(const VoigtParams& params = {}) noexcept : params_(params) {}
  ARTUS_REALTIME void reset(double depth) noexcept;
  ARTUS_REALTIME Wrench step(const NeedleTick& tick) noexcept;

 private:
  VoigtParams params_;
};

}  // namespace artus
