// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstdint>
#include <filesystem>
#include <iosfwd>
#include <string>
#include <vector>

#include "artus/core/result.h"
#include "artus/detail/session/record/recording_head.h"
#include "artus/detail/simulation/records.h"

namespace artus {

/// A tick as it is kept: what went in, and what came out to compare a replay with.
struct TickRecord {
  TickInput input;
  double force[3] = {};         ///< N, frame W  NOLINT(*-avoid-c-arrays)
  double torque[3] = {};        ///< N m  NOLINT(*-avoid-c-arrays)
  double probe_force[3] = {};   ///< N, frame W  NOLINT(*-avoid-c-arrays)
  double probe_torque[3] = {};  ///< N m  NOLINT(*-avoid-c-arrays)
  PlungerFeedback plunger;
  std::uint32_t status = 0;
  std::uint32_t region = 0;
};
[[nodiscard]] ARTUS_REALTIME TickRecord to_record(const HapticSnapshot& snapshot) noexcept;

/// An image as it is kept: what went in, and the digests of what came out.
struct FrameRecord {
  FrameInput input;
  std::uint64_t digest = 0;
  std::uint64_t packet = 0;  ///< digest of what the tissue answered the hands with; 0: rigid
  /// dB, needle_contrast of what came out; not a number: nothing of the tip shows.
  double tip_contrast = std::numeric_limits<double>::quiet_NaN();
};
/// The picture of `input` as it is kept, without its packet. Requires: the session's transducer.
[[nodiscard]] FrameRecord to_record(const FrameInput& input, const Frame& frame,
                                    const Transducer& transducer);

/// What the tissue answers the hands with, and the first tick that felt it.
struct PacketRecord {
  std::uint64_t tick = 0;
  TissuePacket packet;
};
static_assert(std::is_trivially_copyable_v<PacketRecord>);

/// What stands before each record of the file, and the kinds there are (docs/recording-format.md).
struct RecordStart {
  static constexpr std::uint32_t kTick = 1;
  static constexpr std::uint32_t kFrame = 2;
  static constexpr std::uint32_t kEnd = 3;
  static constexpr std::uint32_t kPacket = 4;
  std::uint32_t kind = 0;
  std::uint32_t size = 0;  ///< bytes that follow
};

/// A whole recording in memory.
struct Recording {
  RecordingHead head;
  std::vector<TickRecord> ticks;
  std::vector<FrameRecord> frames;
  std::vector<PacketRecord> packets;
  std::uint64_t dropped = 0;  ///< ticks and frames that did not reach the file
  bool complete = false;      ///< the session ended in good order
};

/// What is wrong with a record; null: nothing. `last`: number of the tick or image before, 0 for
/// none. Every pose is one, every flag and count in its range, every result finite.
[[nodiscard]] const char* find_fault(const TickRecord& record, std::uint64_t last) noexcept;
[[nodiscard]] const char* find_fault(const FrameRecord& record, std::uint64_t last) noexcept;
[[nodiscard]] const char* find_fault(const PacketRecord& record, std::uint64_t last) noexcept;

/// Writes a recording as a session would. Errors: unreadable.
[[nodiscard]] Result<void> write_recording(const Recording& recording,
                                           const std::filesystem::path& file);

/// Reads a recording; what a crash cut off is left out. Errors: not_found, those of parse_head,
/// corrupt (a record that cannot be, with its number).
[[nodiscard]] Result<Recording> read_recording(const std::filesystem::path& file);
/// The same from a stream; `where` names it in errors.
[[nodiscard]] Result<Recording> read_recording(std::istream& in, const std::string& where);

}  // namespace artus
