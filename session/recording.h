// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <atomic>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "artus/core/result.h"
#include "artus/session/session_core.h"
#include "artus/session/session_exchange.h"

namespace artus {

/// A tick as it is kept: what went in, and what came out to compare a replay with.
struct TickRecord {
  TickInput input;
  double force[3] = {};   ///< N, frame W  NOLINT(*-avoid-c-arrays)
  double torque[3] = {};  ///< N m  NOLINT(*-avoid-c-arrays)
  std::uint32_t status = 0;
  std::uint32_t region = 0;
};
[[nodiscard]] ARTUS_REALTIME TickRecord to_record(const HapticSnapshot& snapshot) noexcept;

/// An image as it is kept: what went in, and the digest of its pixels.
struct FrameRecord {
  FrameInput input;
  std::uint64_t digest = 0;
};

/// What a recording says about itself; a line of JSON at the file's start.
struct RecordingHead {
  std::string joint;          ///< name
  std::string source_digest;  ///< CompiledJoint::source_digest
  std::string device;         ///< DeviceLimits::name
  double haptic_rate = 0;     ///< Hz
  double image_rate = 0;      ///< Hz
  std::uint64_t seed = 0;     ///< of speckle and noise
  PlainPose X_WJ;
  GestureParams gesture;
  NeedleFeel feel;
};
[[nodiscard]] RecordingHead make_head(const CompiledJoint& joint, const SessionParams& params);

/// A whole recording in memory.
struct Recording {
  RecordingHead head;
  std::vector<TickRecord> ticks;
  std::vector<FrameRecord> frames;
  std::uint64_t dropped = 0;  ///< ticks and frames that did not reach the file
  bool complete = false;      ///< the session ended in good order
};

/// Reads a recording; what a crash cut off is left out. Errors: not_found, unreadable, unsupported
/// (another version), corrupt.
[[nodiscard]] Result<Recording> read_recording(const std::filesystem::path& file);

/// Writes a session's inputs to a file from a thread of its own. The session's threads hand over
/// records through rings and never wait; a record that finds its ring full is dropped and counted.
class Recorder {
 public:
  /// Errors: unreadable when the file cannot be made.
  [[nodiscard]] static Result<std::unique_ptr<Recorder>> start(const std::filesystem::path& file,
                                                               const RecordingHead& head);
  /// Writes what is left and closes.
  ~Recorder();
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  ARTUS_REALTIME void add(const TickRecord& record) noexcept { ticks_.push(record); }
  ARTUS_REALTIME void add(const FrameRecord& record) noexcept { frames_.push(record); }
  [[nodiscard]] std::uint64_t dropped() const noexcept {
    return ticks_.dropped() + frames_.dropped();
  }

 private:
  struct FileCloser {
    void operator()(std::FILE* file) const noexcept { std::fclose(file); }
  };
  explicit Recorder(std::FILE* file);
  void drain();
  void run();

  std::unique_ptr<std::FILE, FileCloser> file_;
  SpscRing<TickRecord> ticks_;
  SpscRing<FrameRecord> frames_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace artus
