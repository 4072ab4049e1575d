// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include "artus/detail/training/metrics/attempt_meter.h"
#include "artus/session/recording.h"

namespace artus {

/// What one tick of a session adds to a meter. `period`: s, of the tick. Poses count while the
/// device is alive and has them.
ARTUS_REALTIME void add_tick(AttemptMeter& meter, const HapticSnapshot& snapshot,
                             double period) noexcept;

/// Whether a tip stands out that does so by `contrast_db`, its time left open.
[[nodiscard]] ImageSight sight_of(std::optional<double> contrast_db);

/// What one picture adds. `time`: s, on the ticks' clock.
void add_frame(AttemptMeter& meter, const FrameInput& input, const Frame& frame, double time);

/// Options of a meter for a recorded session: its probe, its needle, its first picture's depth.
[[nodiscard]] MeterOptions options_for(const RecordingHead& head);

/// Where the sights of a recording's pictures come from.
enum class SightSource {
  none,      ///< pictures are not measured
  recorded,  ///< as they were when they were drawn; pictures that never were are drawn
  drawn      ///< each picture is drawn again
};

/// Measures a recording by replaying its ticks, and its pictures as `sights` says: those recorded
/// and those drawn again are the same. Errors: those of replay.
[[nodiscard]] Result<AttemptMeasures> assess(const Recording& recording,
                                             const std::shared_ptr<const Scene>& scene,
                                             MeterOptions options, SightSource sights);

}  // namespace artus
