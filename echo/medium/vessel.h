// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <optional>

#include "artus/anatomy/compiled_joint.h"
#include "artus/detail/echo/medium/material_map.h"

namespace artus {

/// How blood runs in a vessel: along it, fastest in the middle and at rest at the wall
/// (Poiseuille), with the heart's beat in an artery and with the breath in a vein.
struct Vessel {
  bool is_artery = false;
  double radius = 0;   ///< m, of a round tube of its volume and surface
  double towards = 1;  ///< 1 or -1: which way blood runs along the course
  MaterialMap course;  ///< its third coordinate runs along the vessel

  /// Unit, frame J: where blood runs at `p_J` (frame J, of the tissue at rest).
  [[nodiscard]] Vec3 direction(const Vec3& p_J) const noexcept;
  /// m/s in the middle at `time` (s); a vein's does not turn round. Cost: constant.
  [[nodiscard]] double middle_speed(double time) const noexcept;
};

/// Peak speed in the middle of an artery at rest over its diameter, 1/s: 1.14 m/s at 8.2 mm and
/// 0.69 m/s at 5.2 mm [Jager1985].
inline constexpr double kArterialRate = 136;

/// The vessel that `region` is; none: no blood runs there, or the body has no tetrahedra. Blood of
/// an artery runs down (-z of frame J, standing) where it does not lie level, a vein's up. Cost:
/// some 5 ms.
[[nodiscard]] std::optional<Vessel> find_vessel(const CompiledJoint& joint, RegionId region);

}  // namespace artus
