// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "artus/core/result.h"
#include "artus/detail/core/progress.h"
#include "artus/detail/evidence/runs/three_injections.h"
#include "artus/echo/image_settings.h"
#include "artus/echo/labels.h"
#include "artus/echo/needle_view.h"
#include "artus/echo/transducer.h"

namespace artus {

struct RunImagesOptions {
  Transducer transducer;
  ImageSettings settings;
  NeedleShape needle;  ///< its length is replaced by the run's
  bool video = true;
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

/// Draws what the probe saw during a run in a rigid body: a B-mode and a label image for every
/// named moment, and a video of the whole run with the forces of the moment below. The probe is
/// where its hand holds it, and lines whose elements do not touch are black. Errors: unreadable
/// (cannot write), unsupported (no video codec). Cost: tens of ms a frame.
[[nodiscard]] Result<RunImages> write_run_images(const std::shared_ptr<const Scene>& scene,
                                                 const ThreeInjections& run,
                                                 const std::filesystem::path& folder,
                                                 const RunImagesOptions& options,
                                                 const Progress& progress = {});

class RunPainter;

/// The same of a run in tissue that gives way, while it goes on: each picture is drawn of the very
/// body that both hands feel. A moment's picture is the next image's, at most a period later.
class LiveRunImages {
 public:
  LiveRunImages(std::shared_ptr<const Scene> scene, std::filesystem::path folder,
                const RunImagesOptions& options, double image_rate);
  ~LiveRunImages();
  LiveRunImages(const LiveRunImages&) = delete;
  LiveRunImages& operator=(const LiveRunImages&) = delete;

  /// For RunTissueOptions::on_image.
  void see(const ThreeInjections& run, const std::shared_ptr<const Scene>& body,
           const FluidState& fluid);
  /// Once the run is over. Errors: those of write_run_images, of any image.
  [[nodiscard]] Result<RunImages> finish();

 private:
  Result<void> draw(const ThreeInjections& run, const std::shared_ptr<const Scene>& body,
                    const FluidState& fluid);

  RunImagesOptions options_;
  std::unique_ptr<RunPainter> painter_;
  RunImages images_;
  std::optional<Error> failed_;  // the first
};

/// File names relative to the run's folder, times and the needle's truth.
[[nodiscard]] nlohmann::json summarize(const RunImages& images);

}  // namespace artus
