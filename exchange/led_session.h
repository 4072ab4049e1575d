// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <memory>
#include <vector>

#include "artus/core/result.h"
#include "artus/dataset/pose_list.h"
#include "artus/detail/session/record/simulation_recorder.h"
#include "artus/raycast/scene.h"
#include "artus/session/recording.h"

namespace artus {

/// The recording of a session in which probe and needle are led through listed poses (of a list, or
/// of a tracker's sequence): whoever reads recordings can read such lists, too. With times they are
/// sampled at the session's haptic rate, without each is one tick; images come at its image rate.
/// Tissue gives way to both hands as in any session, whether pictures are drawn or not. Requires:
/// valid params. Errors: those of sample_path. Cost: of the session's ticks, of the tissue's steps
/// when it gives way, and of the images when they are drawn.
[[nodiscard]] Result<Recording> record_led_session(
    const std::vector<ListedPose>& poses, const std::shared_ptr<const Scene>& scene,
    const SessionParams& params, RecordedPictures pictures = RecordedPictures::drawn);

}  // namespace artus
