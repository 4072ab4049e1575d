// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/haptics/needle/laws/skin_puncture.h"

namespace artus {

NeedlePlace SkinPuncture::between(const NeedlePlace& now, double depth) const noexcept {
  if (!known_ || !(now.depth > last_.depth)) return now;
  const double share = std::clamp((depth - last_.depth) / (now.depth - last_.depth), 0.0, 1.0);
  return {last_.tip + share * (now.tip - last_.tip),
          last_.orientation.slerp(share, now.orientation),
          last_.depth + share * (now.depth - last_.depth)};
}

void SkinPuncture::go_away(const NeedlePlace& now) noexcept {
  const double away = std::max(-now.depth, (now.tip - hole_).norm() - kAside);
  away_ = std::min(edge_, std::max(away_, away));
}

}  // namespace artus
