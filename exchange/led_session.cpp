// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/exchange/led_session.h"

#include <cmath>
#include <optional>

#include "artus/detail/simulation/image_core.h"

namespace artus {
namespace {

TickInput input_of(const ListedPose& pose, const SessionParams& params, std::uint64_t tick) {
  TickInput input;
  input.tick = tick;
  input.device.X_WP = to_plain(params.X_WJ * pose.X_JP);
  input.device.has_probe = 1;
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
                                     const SessionParams& params, LedPictures pictures) {
  const auto path = sample_path(poses, params.haptic_rate);
  ARTUS_TRY(path);
  Recording recording;
  recording.head = make_head(scene->joint(), params);
  recording.complete = true;
  HapticCore haptics(scene, params);
  std::optional<ImageCore> images;
  if (params.deform || pictures == LedPictures::drawn) images.emplace(scene, params);
  const ImageControls controls = controls_of(params);
  std::uint64_t n_images = 0;
  for (std::size_t i = 0; i < path->size(); ++i) {
    const HapticSnapshot& felt = haptics.step(input_of((*path)[i], params, i + 1));
    recording.ticks.push_back(to_record(felt));
    if (static_cast<double>(i) * params.image_rate <
        static_cast<double>(n_images) * params.haptic_rate)
      continue;
    FrameRecord frame;
    frame.input = frame_input(felt, controls, ++n_images);
    ImagedBody body;
    if (images) body = images->advance(frame.input);
    if (pictures == LedPictures::drawn)
      frame = to_record(frame.input, images->render(frame.input, body), params.transducer);
    if (body.packet) {
      frame.packet = digest_of(*body.packet);
      recording.packets.push_back({felt.input.tick + 1, *body.packet});
      haptics.take(*body.packet);
    }
    if (pictures != LedPictures::none) recording.frames.push_back(frame);
  }
  return recording;
}

}  // namespace artus
