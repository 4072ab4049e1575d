// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include "artus/session/recording.h"
#include "artus/training/metrics/attempt_meter.h"

namespace artus {

/// What one tick of a session adds to a meter. `period`: s, of the tick. Poses count while the
/// device is alive and has them.
ARTUS_REALTIME void add_tick(AttemptMeter& meter, const HapticSnapshot& snapshot,
                             double period) noexcept;

/// Whether the tip stands out where it shows in one picture, its time left open.
[[nodiscard]] ImageSight sight_of(const Transducer& transducer, const Frame& frame);

/// What one picture adds. `time`: s, on the ticks' clock.
void add_frame(AttemptMeter& meter, const FrameInput& input, const Frame& frame, double time);

/// Options of a meter for a recorded session: its probe, its needle, its first picture's depth.
[[nodiscard]] MeterOptions options_for(const RecordingHead& head);

/// Measures a recording by replaying its ticks, and its pictures too when asked. Errors: those of
/// replay.
[[nodiscard]] Result<AttemptMeasures> assess(const Recording& recording,
                                             const std::shared_ptr<const Scene>& scene,
                                             MeterOptions options, bool pictures);

}  // namespace artus
