// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <filesystem>
#include <map>
#include <string>
#include <string_view>

#include "artus/core/result.h"
#include "artus/detail/exchange/tracker_track.h"

namespace artus {

/// What stands before the pixels of a sequence: of a MetaImage (.mha, .mhd) or an NRRD file (.nrrd)
/// of PLUS and 3D Slicer.
struct SequenceHeader {
  using Fields = std::map<std::string, std::string, std::less<>>;
  Fields fields;                         ///< of the whole file
  std::map<std::size_t, Fields> frames;  ///< by number, "Seq_Frame0007_X" as X
  std::size_t bytes = 0;                 ///< of the header, behind which pixels may stand
};

/// Errors: malformed with name:line (a line that is no field, an end before the last one).
[[nodiscard]] Result<SequenceHeader> parse_sequence_header(std::string_view bytes,
                                                           const std::string& name);
/// The same of a file, of which nothing behind the header is read. Errors: also not_found,
/// unreadable.
[[nodiscard]] Result<SequenceHeader> read_sequence_header(const std::filesystem::path& file);

/// The motion in it; pixels do not matter. Transforms that are not "OK" were not seen. Needle and
/// probe are composed of what each frame has (TransformGraph). Errors: invalid or malformed, all
/// faults at once (a matrix that is not 16 numbers or not rigid, no time, a time that falls, no
/// frame with probe or needle, with what the file has).
[[nodiscard]] Result<TrackerTrack> track_of(const SequenceHeader& header, const std::string& name,
                                            const TrackNames& names = {});

}  // namespace artus
