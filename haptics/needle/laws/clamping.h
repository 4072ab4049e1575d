// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include "artus/detail/haptics/needle/laws/force_model.h"

namespace artus {

/// The tissue holds the shaft on its line: f = k |QP| towards Q, the orthogonal projection of the
/// tip on the line. k grows with depth and with the layers crossed: each adds its clamping
/// stiffness * length / needle length. Because k grows with depth, a small axial force
/// -1/2 (dk/dx) |QP|^2 belongs to it: without it, a tip moved aside near the skin, pushed in and
/// let go would give energy. Source [Alamilla2020] eq. 2.20; the axial part is added here.
class Clamping {
 public:
  ARTUS_REALTIME void reset(double depth) noexcept;
  ARTUS_REALTIME Wrench step(const NeedleTick& tick) noexcept;
};

/// Lateral stiffness of the tissue around the shaft at this depth, N/m.
[[nodiscard]] ARTUS_REALTIME double clamping_stiffness(const NeedleTick& tick) noexcept;

}  // namespace artus
