// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <optional>
#include <vector>

#include <opencv2/core.hpp>

#include "artus/detail/echo/medium/region_acoustics.h"
#include "artus/echo/image_settings.h"
#include "artus/echo/labels.h"
#include "artus/echo/transducer.h"
#include "artus/raycast/scene.h"

namespace artus {

/// Where muscle shows as in published images of it: thick, its fibres nearly along the face.
class MuscleFinder {
 public:
  /// Requires: valid transducer and settings.
  MuscleFinder(const Scene& scene, const Transducer& transducer, const ImageSettings& settings);

  /// Patches of `size` px of muscle alone, see find_muscle_patches, whose fibres rise by at most 20
  /// degrees from the face, as in the published images. Muscle without fibres counts.
  [[nodiscard]] std::vector<cv::Rect> find_patches(const Pose& X_JP, int size,
                                                   std::size_t count) const;

  /// The pose nearest to `X_JP`, up to 40 mm away along the skin in steps of 10 mm, in which there
  /// is a patch: what one does at the bedside, slide the probe until muscle fills the picture. It
  /// stands upright on the skin there. Empty when there is none, or no skin below the probe.
  [[nodiscard]] std::optional<Pose> slide_to_muscle(const Pose& X_JP, int size) const;

 private:
  [[nodiscard]] double fibre_slope(const Pose& X_JP, const LabelImage& labels,
                                   const cv::Rect& patch) const;
  [[nodiscard]] std::optional<Pose> stand_on_skin(const Pose& X_JP) const;
  [[nodiscard]] bool touches(const Pose& X_JP) const;

  const Scene* scene_;
  Transducer transducer_;
  double gel_limit_;  // m
  LabelRenderer labels_;
  std::vector<RegionAcoustics> regions_;
};

}  // namespace artus
