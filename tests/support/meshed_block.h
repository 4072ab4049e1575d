// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <span>

#include "artus/detail/anatomy/body/meshed_block.h"
#include "tests/support/layered_body.h"

namespace artus::test {

[[nodiscard]] inline CompiledJoint make_meshed_block(std::span<const FlatLayer> layers,
                                                     double width_x, double depth_y, double cell) {
  return artus::make_meshed_block(make_test_tissues(), layers, width_x, depth_y, cell);
}

}  // namespace artus::test
