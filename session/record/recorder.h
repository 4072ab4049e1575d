// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "artus/session/recording.h"

namespace artus {

/// Writes a session's inputs to a file from a thread of its own. The session's threads hand over
/// records through rings and never wait; a record that finds its ring full is dropped and counted.
class Recorder {
 public:
  /// Errors: unreadable when the file cannot be made.
  [[nodiscard]] static Result<std::unique_ptr<Recorder>> start(const std::filesystem::path& file,
                                                               const RecordingHead& head);
  /// finish(), whose answer nobody waits for.
  ~Recorder();
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  /// From the haptic thread, and from the imaging thread.
  ARTUS_REALTIME void add(const TickRecord& record) noexcept;
  ARTUS_REALTIME void add(const FrameRecord& record) noexcept;
  ARTUS_REALTIME void add(const PacketRecord& record) noexcept;
  [[nodiscard]] std::uint64_t dropped() const noexcept;
  /// Why the file does not take what it should, in the system's words; empty: it does.
  [[nodiscard]] std::string trouble() const;
  /// Writes what is left and closes; nothing may be added any more. Errors: unreadable, a file that
  /// did not take all of it (a full disk): what is there is no whole recording. Again: the same.
  [[nodiscard]] Result<void> finish();

 private:
  struct Impl;
  explicit Recorder(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace artus
