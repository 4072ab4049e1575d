// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>

#include "artus/detail/simulation/imaged_body.h"
#include "artus/session/recording.h"

namespace artus {

class Simulation;

/// What a replay found: how many results are the same bytes as those recorded.
struct ReplayReport {
  std::uint64_t ticks = 0;
  std::uint64_t different_ticks = 0;
  std::optional<std::uint64_t> first_different_tick;
  std::uint64_t frames = 0;
  std::uint64_t different_frames = 0;
  std::optional<std::uint64_t> first_different_frame;
  std::uint64_t dropped = 0;  ///< that the recording lacks
  bool complete = false;
  /// There was nothing to compare: the recording is a head alone.
  [[nodiscard]] bool empty() const noexcept { return ticks == 0 && frames == 0; }
  [[nodiscard]] bool identical() const noexcept {
    return !empty() && different_ticks == 0 && different_frames == 0;
  }
};

/// Who wants to see what comes out; empty functions are not called.
struct ReplayListener {
  std::function<void(const HapticSnapshot&)> on_tick;
  std::function<void(const FrameRecord&, const Frame&)> on_frame;
  /// After the last image, with its input.
  std::function<void(Simulation&, const FrameInput&)> on_end;
};

/// Whether its pictures are inputs alone, as of a list of poses or a session without pictures.
[[nodiscard]] bool none_was_drawn(const Recording& recording);

/// Feeds a recording's inputs through the same Simulation as the session that made it, with the
/// params in its head, and compares each force bit for bit and each image by digest. Images that
/// were not drawn are tissue's steps alone, unless none was and `listener` wants to see them. Ticks
/// that the recording lacks make later ones differ. `n_threads`: of the imaging, which the images
/// do not depend on; 0: all processors. `prepared`: of the scene's joint. Errors: invalid when
/// `scene` is another joint than the one recorded.
[[nodiscard]] Result<ReplayReport> replay(const Recording& recording,
                                          const std::shared_ptr<const Scene>& scene,
                                          const ReplayListener& listener = {}, int n_threads = 0,
                                          PreparedBody prepared = {});

}  // namespace artus
