// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstddef>
#include <vector>

#include "artus/anatomy/compiled_joint.h"
#include "artus/core/geometry.h"

namespace artus::bench {

/// Five nested spheres, 102,400 triangles, of shoulder size and place.
[[nodiscard]] CompiledJoint make_body();

/// `count` segments between random points of the cube around the body.
[[nodiscard]] std::vector<Segment> make_random_segments(std::size_t count);

/// `count` needle poses: strokes of 1000 ticks from 10 mm outside the skin to 45 mm inside, each
/// query the segment from the hub to the tip. Neighbours in time are neighbours in space.
[[nodiscard]] std::vector<Segment> make_strokes(std::size_t count);

}  // namespace artus::bench
