// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/training/session_meter.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "artus/detail/session/record/needle_contrast.h"
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
  SyringeTick syringe{
      time,        plunger.flow, plunger.given, plunger.thumb_force, plunger.pressure,
      felt.region, felt.tip};
  for (std::size_t k = 0; k < std::min<std::size_t>(snapshot.n_sites, syringe.held.size()); ++k)
    syringe.held[k] = {static_cast<RegionId>(snapshot.sites[k].region), snapshot.sites[k].volume};
  meter.add_syringe(syringe);
}

ImageSight sight_of(std::optional<double> contrast_db) {
  ImageSight sight;
  sight.contrast_db = contrast_db;
  sight.visible = contrast_db && *contrast_db >= kVisibleContrast;
  return sight;
}

void add_frame(AttemptMeter& meter, const FrameInput& input, const Frame& frame, double time) {
  if (input.controls.motion != MotionShown::none) meter.add_coloured(time);
  if (input.has_needle == 0) return;
  ImageSight sight = sight_of(needle_contrast(input, frame, meter.options().transducer));
  sight.time = time;
  meter.add_sight(sight);
}

MeterOptions options_for(const RecordingHead& head) {
  MeterOptions options;
  options.transducer = head.params.transducer;
  options.image_depth = head.params.image.depth;
  options.needle = head.params.needle_shape;
  options.look = head.params.image.look;
  return options;
}

namespace {

/// Times of pictures on the ticks' clock: of the last tick that was not before them. To be asked
/// in order.
class TickClock {
 public:
  explicit TickClock(const Recording& recording)
      : ticks_(recording.ticks), period_(1 / recording.head.params.haptic_rate) {}

  [[nodiscard]] double time_of(const FrameInput& input) noexcept {
    while (at_ + 1 < ticks_.size() && ticks_[at_].input.device.time_ns < input.sample_time_ns)
      ++at_;
    return ticks_.empty() ? 0 : static_cast<double>(ticks_[at_].input.tick) * period_;
  }

 private:
  const std::vector<TickRecord>& ticks_;
  double period_;  // s
  std::size_t at_ = 0;
};

void add_recorded_sights(AttemptMeter& meter, const Recording& recording) {
  TickClock clock(recording);
  for (const FrameRecord& frame : recording.frames) {
    const double time = clock.time_of(frame.input);
    if (frame.digest == 0) continue;
    if (frame.input.controls.motion != MotionShown::none) meter.add_coloured(time);
    if (frame.input.has_needle == 0) continue;
    const double contrast = frame.tip_contrast;
    ImageSight sight = sight_of(std::isnan(contrast) ? std::nullopt : std::optional(contrast));
    sight.time = time;
    meter.add_sight(sight);
  }
}

}  // namespace

Result<AttemptMeasures> assess(const Recording& recording,
                               const std::shared_ptr<const Scene>& scene, MeterOptions options,
                               SightSource sights) {
  const double period = 1 / recording.head.params.haptic_rate;
  if (!recording.ticks.empty())
    options.longest = 1 + period * static_cast<double>(recording.ticks.back().input.tick -
                                                       recording.ticks.front().input.tick);
  AttemptMeter meter(scene, std::move(options));
  const bool recorded = sights == SightSource::recorded && !none_was_drawn(recording);
  const bool draws = sights != SightSource::none && !recorded;
  ReplayListener listener;
  listener.on_tick = [&](const HapticSnapshot& s) {
    add_tick(meter, s, period);
  };
  TickClock clock(recording);
  listener.on_frame = [&](const FrameRecord& record, const Frame& frame) {
    add_frame(meter, record.input, frame, clock.time_of(record.input));
  };
  Recording ticks_alone;
  const Recording* played = &recording;
  if (!draws) {
    ticks_alone.head = recording.head;
    ticks_alone.ticks = recording.ticks;
    ticks_alone.packets = recording.packets;
    played = &ticks_alone;
  }
  const auto report = replay(*played, scene, listener);
  ARTUS_TRY(report);
  if (recorded) add_recorded_sights(meter, recording);
  return meter.measure();
}

}  // namespace artus
