// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <string>
#include <string_view>

#include "artus/core/result.h"
#include "artus/detail/exchange/tracker_track.h"

namespace artus {

/// Reads a recording of PerkTutor, XML with an element `log` for each transform (TimeStampSec,
/// TimeStampNSec, DeviceName "NeedleToReference", transform: 16 numbers in millimetres). Its
/// transforms come one by one: a frame is made whenever the needle's came (the probe's where there
/// is no needle), and the other hand is where it was last seen, not longer ago than 0.5 s. Messages
/// in it become notices. Errors: malformed (no such XML, with its line); invalid, all faults at
/// once (a time or matrix that is none, no needle or probe, with what the file has).
[[nodiscard]] Result<TrackerTrack> parse_perk_recording(std::string_view text,
                                                        const std::string& name,
                                                        const TrackNames& names = {});

}  // namespace artus
