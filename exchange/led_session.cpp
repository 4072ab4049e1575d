// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/exchange/led_session.h"

#include <cmath>

#include "artus/detail/session/record/simulation_recorder.h"

namespace artus {
namespace {

TickInput input_of(const ListedPose& pose, const SessionParams& params, std::uint64_t tick) {
  TickInput input;
  input.tick = tick;
  if (pose.has_probe) {
    input.device.X_WP = to_plain(params.X_WJ * pose.X_JP);
    input.device.has_probe = 1;
  }
  if (pose.X_JN) {
    input.device.X_WN = to_plain(params.X_WJ * *pose.X_JN);
    input.device.has_needle = 1;
  }
  input.device.number = tick;
  input.device.time_ns = std::llround(1e9 * static_cast<double>(tick) / params.haptic_rate);
  input.device.state = PeerState::alive;
  return input;
}

}  // namespace

Result<Recording> record_led_session(const std::vector<ListedPose>& poses,
                                     const std::shared_ptr<const Scene>& scene,
                                     const SessionParams& params, RecordedPictures pictures) {
  const auto path = sample_path(poses, params.haptic_rate);
  ARTUS_TRY(path);
  Recording recording;
  Simulation simulation(scene, params);
  SimulationRecorder recorder(simulation, recording, pictures);
  for (std::size_t i = 0; i < path->size(); ++i) recorder.step(input_of((*path)[i], params, i + 1));
  return recording;
}

}  // namespace artus
