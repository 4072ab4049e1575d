// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "artus/core/geometry.h"
#include "artus/core/result.h"

namespace artus {

/// "x,y,z" in millimetres of the joint frame -> metres. Errors: malformed (not three finite
/// numbers); `flag` names the option in the message.
[[nodiscard]] Result<Vec3> parse_point_mm(std::string_view text, const std::string& flag);

/// "x,y,z/dx,dy,dz/lx,ly,lz": footprint centre in millimetres, direction into the body, lateral
/// direction of the scanlines' row (optional) -> pose X_JP. Errors: malformed; invalid when a
/// direction is zero or the two are parallel.
[[nodiscard]] Result<Pose> parse_probe_pose(std::string_view text, const std::string& flag);

/// "ex,ey,ez/tx,ty,tz": a point on the needle's shaft (the skin entry) and its tip in millimetres
/// -> pose X_JN, origin at the tip, z from hub to tip. Errors: malformed; invalid when they
/// coincide.
[[nodiscard]] Result<Pose> parse_needle_pose(std::string_view text, const std::string& flag);

/// m of "mm", "cm" or "m". Requires: one of them.
[[nodiscard]] double length_unit(std::string_view name);

/// Entry and tip of "ex,ey,ez/tx,ty,tz", metres. Errors: as parse_needle_pose.
[[nodiscard]] Result<Segment> parse_entry_and_tip(std::string_view text, const std::string& flag);

}  // namespace artus
