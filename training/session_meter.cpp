// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/training/session_meter.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "artus/session/replay.h"

namespace artus {
namespace {

Vec3 vector_of(const double (&v)[3]) noexcept {
  return {v[0], v[1], v[2]};
}

}  // namespace

void add_tick(AttemptMeter& meter, const HapticSnapshot& snapshot, double period) noexcept {
  const DeviceSample& device = snapshot.input.device;
  if (device.state != PeerState::alive) return;
  const double time = static_cast<double>(snapshot.input.tick) * period;
  if (device.has_needle != 0)
    meter.add_needle(time, vector_of(snapshot.X_JN.position), rotation_of(snapshot.X_JN));
  if (device.has_probe != 0)
    meter.add_probe(time, vector_of(snapshot.X_JP.position), rotation_of(snapshot.X_JP));
  if (device.has_needle == 0) return;
  FeltTick felt;
  felt.time = time;
  felt.region = static_cast<RegionId>(snapshot.feedback.region);
  felt.tissue = std::abs(snapshot.axial[1] + snapshot.axial[2] + snapshot.axial[3]);
  felt.hard =
      std::abs(snapshot.axial[1] + snapshot.axial[2] + snapshot.axial[3] + snapshot.axial[4]);
  felt.on_bone = snapshot.feedback.contact == static_cast<std::uint32_t>(ContactState::bone);
  felt.tip = vector_of(snapshot.X_JN.position);
  meter.add_felt(felt);
  const PlungerFeedback& plunger = snapshot.feedback.plunger;
  meter.add_syringe({time, plunger.flow, plunger.given, plunger.thumb_force, plunger.pressure,
                     felt.region, felt.tip});
}

ImageSight sight_of(const Transducer& transducer, const Frame& frame) {
  ImageSight sight;
  if (frame.tip_shown) {
    const double left = -0.5 * frame.pixel * frame.width;
    const double x = left + (frame.tip_shown->x + 0.5) * frame.pixel;
    const double top = std::min(0.0, scanline(transducer, 0).origin.z());
    const double z = top + (frame.tip_shown->y + 0.5) * frame.pixel;
    sight.contrast_db = tip_contrast(frame, transducer, x, z);
  }
  sight.visible = sight.contrast_db && *sight.contrast_db >= kVisibleContrast;
  return sight;
}

void add_frame(AttemptMeter& meter, const FrameInput& input, const Frame& frame, double time) {
  if (input.has_needle == 0) return;
  ImageSight sight = sight_of(meter.options().transducer, frame);
  sight.time = time;
  meter.add_sight(sight);
}

MeterOptions options_for(const RecordingHead& head) {
  MeterOptions options;
  options.transducer = head.params.transducer;
  options.image_depth = head.params.image.depth;
  options.needle = head.params.needle_shape;
  return options;
}

Result<AttemptMeasures> assess(const Recording& recording,
                               const std::shared_ptr<const Scene>& scene, MeterOptions options,
                               bool pictures) {
  const double period = 1 / recording.head.params.haptic_rate;
  if (!recording.ticks.empty())
    options.longest = 1 + period * static_cast<double>(recording.ticks.back().input.tick -
                                                       recording.ticks.front().input.tick);
  AttemptMeter meter(scene, std::move(options));
  ReplayListener listener;
  listener.on_tick = [&](const HapticSnapshot& s) {
    add_tick(meter, s, period);
  };
  std::size_t k = 0;
  listener.on_frame = [&](const FrameRecord& record, const Frame& frame) {
    const auto& ticks = recording.ticks;
    while (k + 1 < ticks.size() && ticks[k].input.device.time_ns < record.input.sample_time_ns) ++k;
    const double time = ticks.empty() ? 0 : static_cast<double>(ticks[k].input.tick) * period;
    add_frame(meter, record.input, frame, time);
  };
  Recording ticks_alone;
  const Recording* played = &recording;
  if (!pictures) {
    ticks_alone.head = recording.head;
    ticks_alone.ticks = recording.ticks;
    played = &ticks_alone;
  }
  const auto report = replay(*played, scene, listener);
  ARTUS_TRY(report);
  return meter.measure();
}

}  // namespace artus
