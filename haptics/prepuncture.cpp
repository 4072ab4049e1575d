// SPDX-License-Identifier: AGPL-3.0-or-later
#include "haptics/prepuncture.h"

#include <algorithm>
#include <cmath>

namespace artus {

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

void Prepuncture::reset(double /*depth*/) noexcept {}

Wrench Prepuncture::step(const NeedleTick& tick) noexcept {
  const double force = prepuncture_force(params_, tick.membrane, tick.dimple, tick.velocity);
  return {-force * tick.axis, Vec3::Zero()};
}

}  // namespace artus
