// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <filesystem>
#include <memory>
#include <vector>

#include "artus/core/result.h"
#include "artus/dataset/pose_list.h"
#include "artus/detail/core/progress.h"
#include "artus/echo/image_settings.h"
#include "artus/echo/needle_view.h"
#include "artus/echo/transducer.h"
#include "artus/raycast/scene.h"

namespace artus {

struct SweepVideoOptions {
  Transducer transducer;
  ImageSettings settings;
  NeedleShape needle;
  double frames_per_second = 25;
  bool labels = false;  ///< the true labels beside each image, in colour
};

struct SweepVideo {
  std::filesystem::path file;  ///< .avi where the system cannot write the MP4 that was asked for
  std::size_t frames = 0;
};

/// Draws a path of poses (see sample_path) as a video. Errors: as VideoFile and sample_path.
[[nodiscard]] Result<SweepVideo> write_sweep_video(const std::shared_ptr<const Scene>& scene,
                                                   const std::vector<ListedPose>& poses,
                                                   const std::filesystem::path& file,
                                                   const SweepVideoOptions& options,
                                                   const Progress& progress = {});

}  // namespace artus
