// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/evidence/validation/soft/needled_block.h"

namespace artus {

NeedledBlock::NeedledBlock() {
  block.half_x = block.half_y = 36e-3;
  block.layers = {{2e-3, linear_material(120e3, 0.47)},
                  {6e-3, linear_material(2.4e3, 0.47)},
                  {28e-3, linear_material(7.5e3, 0.47)}};
  const Vec3 zone(9e-3, 9e-3, 36e-3);
  solver = std::make_unique<SoftSolver>(
      make_block_model(block, 6e-3, {{Vec3(-zone.x(), -zone.y(), 0), zone, 3e-3}}),
      std::vector<std::uint32_t>{});
  solver->refresh();
}

NeedleLine NeedledBlock::track(double radius) {
  NeedleLine line;
  line.entry = Vec3(1e-3, 0.7e-3, 0);
  line.length = 32e-3;
  line.radius = radius;
  return line;
}

NeedleCompliance NeedledBlock::compliance(double radius) const {
  return compute_needle_compliance(solver->factored(), track(radius));
}

}  // namespace artus
