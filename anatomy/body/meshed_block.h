// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <span>
#include <vector>

#include "artus/detail/anatomy/body/layered_body.h"

namespace artus {

/// make_layered_block with tetrahedra and with surfaces of about `cell` m: a body that can give
/// way, in no time and without a mesher. Six tetrahedra a cell (Kuhn's division), so that faces
/// conform.
[[nodiscard]] CompiledJoint make_meshed_block(const std::vector<Tissue>& tissues,
                                              std::span<const FlatLayer> layers, double width_x,
                                              double depth_y, double cell);

/// The block stands on something hard: its lower face is an end of what is meshed, and held.
/// Requires: a meshed block.
void stand_on_table(CompiledJoint& block);

/// add_ball in a meshed block: the surface is the ball's, and the tetrahedra whose middle lies in
/// it are of its tissue, so that it gives way as it is. Requires: as add_ball.
void add_meshed_ball(CompiledJoint& block, const Ball& ball, RegionId within, int subdivisions = 3);

}  // namespace artus
