// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include "artus/detail/haptics/needle/laws/force_model.h"

namespace artus {

struct GodObjectParams {
  double stiffness = 1500;  ///< N/m; assumed: the skin's wall stiffness
};

/// The needle on the skin before puncture as a proxy that stays on the surface: the force is a
/// spring from the tip to the proxy, along the surface's normal whatever the needle's direction
/// (frictionless). The proxy is the tip's foot on the tangent plane where the needle crosses the
/// skin. Uses NeedleTick::entry, dimple and surface_normal. Source [Zilles1995].
class GodObject {
 public:
  explicit GodObject(const GodObjectParams& params = {}) noexcept : params_(params) {}
  ARTUS_REALTIME void reset(double depth) noexcept;
  ARTUS_REALTIME Wrench step(const NeedleTick& tick) noexcept;

 private:
  GodObjectParams params_;
};

}  // namespace artus
