// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include "artus/detail/haptics/needle/laws/force_model.h"

namespace artus {

struct HemisphereParams {
  Vec3 centre = Vec3::Zero();  ///< m, frame J
  double radius = 0.15;        ///< m, r_d; [Alamilla2020] section 2.4.2
  double push = 1;             ///< N, K; assumed
};

/// A push of constant size out of a sphere: f = K (p - c) / |p - c| when |p - c| < r_d, none
/// outside. Source [Alamilla2020] eqs. 2.26-2.27, with the position taken relative to the centre
/// (the print uses the tool's coordinates, right only for a centre at the origin).
class HemisphereWorkspace {
 public:
  explicit HemisphereWorkspace(const HemisphereParams& params = {}) noexcept : params_(params) {}
  ARTUS_REALTIME void reset(double /*depth*/) noexcept {}
  ARTUS_REALTIME Wrench step(const NeedleTick& tick) noexcept {
    const Vec3 out = tick.tip - params_.centre;
    const double distance = out.norm();
    if (distance >= params_.radius || distance == 0) return {};
    return {params_.push / distance * out, Vec3::Zero()};
  }

 private:
  HemisphereParams params_;
};

}  // namespace artus
