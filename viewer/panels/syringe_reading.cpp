// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/viewer/panels/syringe_reading.h"

#include <algorithm>

#include "artus/detail/haptics/plunger/bevel.h"

namespace artus {

SyringeReading read_syringe(const Scene& scene, const JointSpaces& spaces,
                            const HapticSnapshot& now, const SessionParams& params) noexcept {
  const PlungerFeedback& felt = now.feedback.plunger;
  SyringeReading reading;
  reading.used = now.input.device.plunger != PlungerSign::none || felt.given > 0;
  reading.left = std::max(0.0, params.syringe.filled - felt.given);
  reading.given = felt.given;
  if ((felt.status & PlungerStatus::kFlash) != 0) reading.drawn = felt.drawn;
  reading.flow = felt.flow;
  reading.thumb = felt.thumb_force;
  reading.pressure = felt.tip_pressure;
  const Pose X_JN = to_pose(now.X_JN);
  const RegionId region =
      scene.region_at(X_JN * Vec3(0, 0, -bevel_middle(params.needle_shape.outer_diameter)));
  if (!reading.used || now.inserted == 0 || region >= spaces.of_region.size()) return reading;
  const Space& space = spaces.spaces[spaces.of_region[region]];
  reading.own = space.liquid;
  double inside = space.law.kind == SpaceKind::open ? felt.given : 0;  // m^3; it is not told of
  for (std::uint32_t k = 0; k < now.n_sites; ++k)
    if (now.sites[k].region < spaces.of_region.size() &&
        spaces.of_region[now.sites[k].region] == spaces.of_region[region])
      inside += now.sites[k].volume;
  reading.patient = feeling_of({space.like, space.law.stop, felt.tip_pressure, inside, felt.flow,
                                (felt.status & PlungerStatus::kClosed) == 0,
                                (felt.status & PlungerStatus::kRuptured) != 0});
  return reading;
}

}  // namespace artus
