// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstdint>
#include <filesystem>
#include <memory>

#include "artus/session/recording.h"

namespace artus {

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

  /// From the haptic thread, and from the imaging thread.
  ARTUS_REALTIME void add(const TickRecord& record) noexcept;
  ARTUS_REALTIME void add(const FrameRecord& record) noexcept;
  ARTUS_REALTIME void add(const PacketRecord& record) noexcept;
  [[nodiscard]] std::uint64_t dropped() const noexcept;

 private:
  struct Impl;
  explicit Recorder(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace artus
