// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/haptics/needle/laws/prepuncture.h"

#include <algorithm>
#include <cmath>

namespace artus {
namespace {
constexpr double kNothing = 1e-6;  // N
}

double prepuncture_force(const PrepunctureParams& params, const LayerHaptics& layer, double d,
                         double v) noexcept {
  if (d <= 0) return 0;
  const SimoneOkamuraParams& liver = params.simone_okamura;
  switch (layer.prepuncture) {
    case PrepunctureLaw::simone_okamura:
      return liver.a1 * d + liver.a2 * d * d;
    case PrepunctureLaw::barbe:
      return std::max(0.0,
                      params.barbe.mu * std::pow(d, params.barbe.n) + params.barbe.lambda * d * v);
    case PrepunctureLaw::god_object:
      return params.god_object.stiffness * d;
    case PrepunctureLaw::membrane:
      break;
  }
  const double full = params.membrane.dimple;
  const double scale = layer.tissue.puncture_force / (liver.a1 * full + liver.a2 * full * full);
  return scale * (liver.a1 * d + liver.a2 * d * d);
}

void Prepuncture::reset(double /*depth*/) noexcept {
  torn_ = 0;
}

void Prepuncture::tear(double force, double dimple, double depth) noexcept {
  if (!(force > 0 && dimple > 0)) return;
  torn_ += force;
  torn_dimple_ = dimple;
  torn_at_ = depth - dimple;
}

Wrench Prepuncture::step(const NeedleTick& tick) noexcept {
  double force = prepuncture_force(params_, tick.membrane, tick.dimple, tick.velocity);
  if (torn_ > 0) {
    force += torn_ * std::clamp((tick.depth - torn_at_) / torn_dimple_, 0.0, 1.0);
    torn_ *= std::exp(-tick.dt / params_.tear.time);
    if (torn_ < kNothing) torn_ = 0;
  }
  return {-force * tick.axis, Vec3::Zero()};
}

}  // namespace artus
