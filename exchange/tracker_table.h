// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <string>
#include <string_view>

#include "artus/core/result.h"
#include "artus/detail/exchange/tracker_track.h"

namespace artus {

/// Whether a text holds a header of a table of positions and quaternions, lines of eight numbers
/// (time, x y z, qx qy qz qw), or times and poses as SOFA writes them ("T=", "X=").
[[nodiscard]] bool is_tracker_table(std::string_view text);

/// Reads it. Tools are probe and needle by their names; where the names do not say, the first is
/// the needle and the second the probe. Lengths and times whose unit is not written are millimetres
/// in NDI's logs, else as their sizes tell; what was assumed stands in the notices. Rows in which a
/// tool was not seen (seven zeros, empty cells, words, NDI's -3.7e28) have no pose of it. Errors:
/// malformed or invalid, all faults at once with their lines (a row that is cut off, a number
/// that is half there, a quaternion whose norm is not 0.9 to 1.1, a time that falls).
[[nodiscard]] Result<TrackerTrack> parse_tracker_table(std::string_view text,
                                                       const std::string& name);

}  // namespace artus
