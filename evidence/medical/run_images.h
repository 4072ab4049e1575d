// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "artus/core/progress.h"
#include "artus/core/result.h"
#include "artus/echo/image_settings.h"
#include "artus/echo/labels.h"
#include "artus/echo/needle_view.h"
#include "artus/echo/transducer.h"
#include "artus/evidence/medical/three_injections.h"

namespace artus {

struct RunImagesOptions {
  Transducer transducer;
  ImageSettings settings;
  NeedleShape needle;  ///< its length is replaced by the run's
  bool video = true;
  bool deform = false;            ///< tissue gives way to the probe; its force stays the columns'
  double frames_per_second = 15;  ///< of the video, which plays in real time
};

/// One named moment as it was drawn.
struct MomentImage {
  std::string label;
  double time = 0;  ///< s
  int pass = 0;
  std::filesystem::path bmode;   ///< annotated B-mode
  std::filesystem::path labels;  ///< what truly lies in the plane, same scale
  NeedleTruth needle;
};

struct RunImages {
  std::vector<MomentImage> moments;
  std::filesystem::path video;  ///< empty when none was asked for
  int video_frames = 0;
};

/// Draws what the probe saw during a run: a B-mode and a label image for every named moment, and a
/// video of the whole run with the forces of the moment below. The probe is where its hand holds
/// it, and lines whose elements do not touch are black. Errors: unreadable (cannot write),
/// unsupported (no video codec), those of TissueCore::make when it deforms. Cost: tens of ms a
/// frame.
[[nodiscard]] Result<RunImages> write_run_images(const std::shared_ptr<const Scene>& scene,
                                                 const ThreeInjections& run,
                                                 const std::filesystem::path& folder,
                                                 const RunImagesOptions& options,
                                                 const Progress& progress = {});

/// File names relative to the run's folder, times and the needle's truth.
[[nodiscard]] nlohmann::json summarize(const RunImages& images);

}  // namespace artus
