// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <optional>

#include "artus/core/geometry.h"

namespace artus {

/// The part of a needle that is in the body.
struct NeedleInside {
  Vec3 tip = Vec3::Zero();    ///< m
  Vec3 entry = Vec3::Zero();  ///< m, where the shaft goes through the skin
};

/// Area that the needle sweeps from `before` to `now`: the triangles (now.tip, before.tip,
/// now.entry) and (now.entry, before.entry, before.tip), m^2. In closed form: 0 in and out along a
/// line; D^2 theta / 2 for a tilt by theta about the entry at depth D; D s for a shift by s.
/// Source [PerkTutor], "Tissue Damage".
[[nodiscard]] inline double swept_area(const NeedleInside& before, const NeedleInside& now) {
  const auto area = [](const Vec3& a, const Vec3& b, const Vec3& c) {
    return 0.5 * (b - a).cross(c - a).norm();
  };
  return area(now.tip, before.tip, now.entry) + area(now.entry, before.entry, before.tip);
}

}  // namespace artus
