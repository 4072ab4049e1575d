// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <vector>

#include "artus/detail/haptics/needle/laws/force_model.h"

namespace artus::test {

/// Regions 2, 3, ... with the given tissues, cut by the wall; 0 is outside, 1 beyond.
inline LayerTable table_of(const std::vector<Haptic>& tissues) {
  std::vector<LayerHaptics> rows(2);
  for (const Haptic& h : tissues)
    rows.push_back({h, CuttingLaw::tracking_wall, PrepunctureLaw::membrane});
  return LayerTable(std::move(rows));
}

inline Haptic soft(double cutting, double stiffness = 500, double attracted = 0.5) {
  Haptic h;
  h.cutting_force = cutting;
  h.wall_stiffness = stiffness;
  h.attracted_force = attracted;
  h.friction = 1;
  h.clamping_stiffness = 200;
  return h;
}

/// A needle on a line along z through one layer of the given tissue.
class AxialTick {
 public:
  explicit AxialTick(const Haptic& tissue, double dt = 1e-3)
      : table_(table_of({tissue})), layers_{{0, 0.1, kFirstRegion}} {
    tick_.dt = dt;
    tick_.table = &table_;
    tick_.layer = table_[kFirstRegion];
    tick_.shaft = layers_;
  }
  AxialTick(const AxialTick&) = delete;
  AxialTick& operator=(const AxialTick&) = delete;

  NeedleTick& at(double depth, Motion motion = Motion::inward, double velocity = 0) {
    tick_.depth = depth;
    tick_.tip = tick_.entry + depth * tick_.axis;
    tick_.stillness = motion == Motion::still ? 1 : 0;
    tick_.velocity = velocity;
    tick_.incoming_speed = std::max(0.0, velocity);
    return tick_;
  }
  NeedleTick& tick() { return tick_; }

 private:
  LayerTable table_;
  std::vector<ShaftLayer> layers_;
  NeedleTick tick_;
};

}  // namespace artus::test
