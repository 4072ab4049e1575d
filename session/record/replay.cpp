// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/session/replay.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <utility>

#include "artus/detail/anatomy/body/joint_digest.h"
#include "artus/simulation/simulation.h"

namespace artus {
namespace {

bool same(const TickRecord& a, const TickRecord& b) noexcept {
  // NOLINTBEGIN(bugprone-suspicious-memory-comparison): a replay gives the same bytes
  return std::memcmp(a.force, b.force, sizeof a.force) == 0 &&
         std::memcmp(a.torque, b.torque, sizeof a.torque) == 0 &&
         std::memcmp(a.probe_force, b.probe_force, sizeof a.probe_force) == 0 &&
         std::memcmp(a.probe_torque, b.probe_torque, sizeof a.probe_torque) == 0 &&
         std::memcmp(&a.plunger, &b.plunger, sizeof a.plunger) == 0 && a.status == b.status &&
         a.region == b.region;
  // NOLINTEND(bugprone-suspicious-memory-comparison)
}

void note(const FrameRecord& recorded, bool same, ReplayReport& report) {
  if (same) return;
  if (!report.first_different_frame) report.first_different_frame = recorded.input.number;
  ++report.different_frames;
}

}  // namespace

bool none_was_drawn(const Recording& recording) {
  return std::none_of(recording.frames.begin(), recording.frames.end(),
                      [](const FrameRecord& frame) { return frame.digest != 0; });
}

Result<ReplayReport> replay(const Recording& recording, const std::shared_ptr<const Scene>& scene,
                            const ReplayListener& listener, int n_threads, PreparedBody prepared) {
  if (compute_joint_digest(scene->joint()) != recording.head.joint_digest)
    return fail(ErrorCode::invalid,
                "the session was recorded with another joint, or another version of it: " +
                    recording.head.joint,
                scene->joint().name);
  SessionParams params = recording.head.params;
  params.image.n_threads = n_threads;
  ReplayReport report;
  report.dropped = recording.dropped;
  report.complete = recording.complete;
  Simulation simulation(scene, params, 0, std::move(prepared));
  auto packet = recording.packets.begin();
  for (const TickRecord& recorded : recording.ticks) {
    for (; packet != recording.packets.end() && packet->tick <= recorded.input.tick; ++packet)
      simulation.take(packet->packet);
    const HapticSnapshot& out = simulation.tick(recorded.input);
    ++report.ticks;
    if (!same(recorded, to_record(out))) {
      if (!report.first_different_tick) report.first_different_tick = recorded.input.tick;
      ++report.different_ticks;
    }
    if (listener.on_tick) listener.on_tick(out);
  }
  const bool listed = none_was_drawn(recording) && listener.on_frame;
  for (const FrameRecord& recorded : recording.frames) {
    const ImagedBody body = simulation.advance(recorded.input);
    ++report.frames;
    const bool same_packet = !body.packet || digest_of(*body.packet) == recorded.packet;
    if (recorded.digest == 0 && !listed) {
      note(recorded, same_packet, report);
      continue;
    }
    const Frame& frame = simulation.render(recorded.input, body);
    const FrameRecord now = to_record(recorded.input, frame, simulation.transducer());
    const bool same_sight = std::bit_cast<std::uint64_t>(now.tip_contrast) ==
                            std::bit_cast<std::uint64_t>(recorded.tip_contrast);
    const bool same_picture = recorded.digest == 0 || (now.digest == recorded.digest && same_sight);
    note(recorded, same_picture && same_packet, report);
    if (listener.on_frame) listener.on_frame(recorded, frame);
  }
  if (listener.on_end && !recording.frames.empty())
    listener.on_end(simulation, recording.frames.back().input);
  return report;
}

}  // namespace artus
